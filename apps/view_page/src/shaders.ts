// The volume is followed ray by ray. Places are in samples: sample i lies at i + 1/2.

export const vertexShader = /* glsl */ `
out vec3 vPlace;
void main() {
  vPlace = position + 0.5;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

export const fragmentShader = /* glsl */ `
precision highp float;
precision highp sampler3D;

in vec3 vPlace;
out vec4 outColor;

uniform sampler3D uVolume;   // parts of the way from the lowest value to the highest
uniform sampler3D uBlocks;   // least and most of what matters in blocks of 8 samples
uniform vec3 uSize;          // samples
uniform vec3 uEye;           // samples
uniform mat3 uStepToWorld;   // from samples to the scene
uniform mat3 uSlopeToWorld;  // its inverse, transposed
uniform mat4 uToClip;        // from the box, -1/2 to 1/2
uniform float uIso;
uniform float uInside;       // 1: inside is above iso, -1: below
uniform bool uFog;
uniform vec2 uFogRange;      // parts without and with most fog
uniform float uThickness;    // extinction per unit of the scene
uniform vec3 uLight;         // to the lamp, scene
uniform vec3 uSky;           // upward, scene
uniform vec3 uColor;
uniform vec3 uInner;

const float kBlock = 8.0;

float valueAt(vec3 p) { return texture(uVolume, p / uSize).r; }

vec2 blockAt(vec3 p, out vec3 low) {
  ivec3 blocks = textureSize(uBlocks, 0);
  ivec3 b = clamp(ivec3(floor(p / kBlock)), ivec3(0), blocks - 1);
  low = vec3(b) * kBlock;
  return texelFetch(uBlocks, b, 0).rg;
}

float leaveBlock(vec3 o, vec3 d, vec3 low) {
  vec3 t = (low + kBlock * step(0.0, d) - o) / d;
  return min(t.x, min(t.y, t.z));
}

vec3 slopeAt(vec3 p) {
  const vec2 e = vec2(1.0, 0.0);
  return 0.5 * vec3(valueAt(p + e.xyy) - valueAt(p - e.xyy),
                    valueAt(p + e.yxy) - valueAt(p - e.yxy),
                    valueAt(p + e.yyx) - valueAt(p - e.yyx));
}

float random(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }

float fogOf(float part) {
  return clamp((part - uFogRange.x) / (uFogRange.y - uFogRange.x), 0.0, 1.0);
}

vec3 toScreen(vec3 c) { return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2)); }

// How much of the light from around reaches a place: what stands along the normal stops it.
float openness(vec3 p, vec3 stepOut) {
  float closed = 0.0, weight = 0.55;
  float reach = 1.5;
  for (int i = 0; i < 5; ++i) {
    float v = (valueAt(p + stepOut * reach) - uIso) * uInside;
    closed += weight * smoothstep(-0.08, 0.05, v);
    weight *= 0.62;
    reach *= 1.75;
  }
  return clamp(1.0 - closed, 0.15, 1.0);
}

vec3 shade(vec3 p, vec3 toEye, bool fromInside) {
  vec3 normal = normalize(uSlopeToWorld * slopeAt(p) * -uInside);
  if (fromInside) normal = -normal;
  if (dot(normal, toEye) < 0.0) normal = normalize(normal - 1.02 * dot(normal, toEye) * toEye);
  // One sample outward.
  vec3 out1 = transpose(uSlopeToWorld) * normal;
  float open = fromInside ? 0.7 : openness(p, out1 / max(length(out1), 1e-9));
  float lamp = max(dot(normal, uLight), 0.0);
  float around = 0.5 + 0.5 * dot(normal, uSky);
  vec3 halfway = normalize(uLight + toEye);
  float gloss = 0.16 * pow(max(dot(normal, halfway), 0.0), 42.0);
  float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
  vec3 base = fromInside ? uInner : uColor;
  vec3 light = vec3(1.0, 0.96, 0.91) * 0.80 * lamp * mix(0.5, 1.0, open) +
               mix(vec3(0.07, 0.065, 0.065), vec3(0.22, 0.26, 0.31), around) * open;
  return base * light + vec3(gloss) * open + 0.08 * rim * open * vec3(0.7, 0.85, 1.0);
}

bool surface(vec3 o, vec3 d, float t0, float t1, out float hit, out bool fromInside) {
  float dt = 0.5 / length(d);
  float before = -1.0, tBefore = t0;
  float t = t0;
  for (int i = 0; i < 4096; ++i) {
    if (t > t1) return false;
    vec3 p = o + d * t;
    vec3 low;
    vec2 range = blockAt(p, low);
    float least = (range.x - uIso) * uInside, most = (range.y - uIso) * uInside;
    float v;
    if (least * most > 0.0) {
      // Of one side as a whole.
      v = sign(least) * 1e-4;
      if (v * before > 0.0) {
        tBefore = max(leaveBlock(o, d, low), t);
        t = tBefore + 0.02 * dt;
        before = v;
        continue;
      }
    } else {
      v = (valueAt(p) - uIso) * uInside;
    }
    if (v * before < 0.0) {
      float a = tBefore, b = t;
      for (int j = 0; j < 7; ++j) {
        float m = 0.5 * (a + b);
        float vm = (valueAt(o + d * m) - uIso) * uInside;
        if (vm * before > 0.0) a = m; else b = m;
      }
      hit = 0.5 * (a + b);
      fromInside = before > 0.0;
      return true;
    }
    if (v != 0.0) before = v;
    tBefore = t;
    t += dt;
  }
  return false;
}

// Light that reaches a place in the fog.
float sunlit(vec3 p, vec3 toLight, float worldStep) {
  float depth = 0.0, reach = 1.0;
  for (int i = 0; i < 6; ++i) {
    vec3 q = p + toLight * (reach * 1.5);
    depth += fogOf(valueAt(q)) * reach;
    reach *= 1.6;
  }
  float tau = depth * worldStep * 1.5 * uThickness;
  // A part of what is scattered goes on forward, and reaches farther.
  return 0.75 * exp(-tau) + 0.25 * exp(-0.2 * tau);
}

vec4 fog(vec3 o, vec3 d, float t0, float t1) {
  float dt = 1.0 / length(d);
  float worldStep = length(uStepToWorld * d) * dt;
  vec3 light = inverse(uStepToWorld) * uLight;
  vec3 toLight = light / length(light);
  float lightStep = length(uStepToWorld * toLight);
  vec3 sum = vec3(0.0);
  float through = 1.0;
  float t = t0 + dt * random(gl_FragCoord.xy);
  for (int i = 0; i < 2048; ++i) {
    if (t > t1 || through < 0.004) break;
    vec3 p = o + d * t;
    vec3 low;
    vec2 range = blockAt(p, low);
    if (max(fogOf(range.x), fogOf(range.y)) < 1e-4) {
      float next = leaveBlock(o, d, low);
      t += dt * (floor(max(next - t, 0.0) / dt) + 1.0);
      continue;
    }
    float density = fogOf(valueAt(p));
    if (density > 1e-4) {
      float kept = exp(-density * uThickness * worldStep);
      vec3 scattered = vec3(1.0, 0.95, 0.88) * 0.85 * sunlit(p, toLight, lightStep) +
                       vec3(0.085, 0.11, 0.145);
      sum += through * (1.0 - kept) * scattered * mix(uColor, vec3(0.92), 0.6);
      through *= kept;
    }
    t += dt;
  }
  float alpha = 1.0 - through;
  return vec4(alpha > 0.0 ? toScreen(sum / alpha) * alpha : vec3(0.0), alpha);
}

void main() {
  vec3 o = uEye;
  vec3 d = vPlace * uSize - uEye;
  // Nothing is divided by zero.
  d = mix(d, vec3(1e-6), lessThan(abs(d), vec3(1e-6)));
  vec3 a = -o / d, b = (uSize - o) / d;
  vec3 enter = min(a, b), leave = max(a, b);
  float t0 = max(max(enter.x, max(enter.y, enter.z)), 0.0);
  float t1 = min(leave.x, min(leave.y, leave.z));
  gl_FragDepth = 1.0;
  if (t1 <= t0) discard;
  if (uFog) {
    outColor = fog(o, d, t0, t1);
    if (outColor.a <= 0.0) discard;
    return;
  }
  float t;
  bool fromInside;
  if (!surface(o, d, t0, t1, t, fromInside)) discard;
  vec3 p = o + d * t;
  vec3 toEye = -normalize(uStepToWorld * d);
  outColor = vec4(toScreen(shade(p, toEye, fromInside)), 1.0);
  vec4 clip = uToClip * vec4(p / uSize - 0.5, 1.0);
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);
}
`;
