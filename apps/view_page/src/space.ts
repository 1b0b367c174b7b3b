// The volume in space: a ray through each pixel of a box, by WebGL 2.
import {
  BoxGeometry,
  BufferGeometry,
  Color,
  CustomBlending,
  Data3DTexture,
  DataUtils,
  EdgesGeometry,
  Float32BufferAttribute,
  BackSide,
  GLSL3,
  HalfFloatType,
  LineBasicMaterial,
  LineLoop,
  LinearFilter,
  LineSegments,
  Matrix3,
  Matrix4,
  Mesh,
  NearestFilter,
  OneFactor,
  OneMinusSrcAlphaFactor,
  PerspectiveCamera,
  RedFormat,
  RGFormat,
  Scene,
  ShaderMaterial,
  Spherical,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { rangesOf } from "./blocks";
import { fragmentShader, vertexShader } from "./shaders";
import { kAxisColors, type Settings } from "./settings";
import type { Volume } from "./volume";

const kRestMilliseconds = 160;
const kMostPixels = 2.6e6;
const kMovingPixels = 0.35e6;
// What draws a picture in this time can draw as many pixels while it moves, and more at rest.
const kFastMilliseconds = 30;

/** From the box, -1/2 to 1/2 along each axis, to a scene whose farthest corner is 1 away. */
function boxToScene(volume: Volume): Matrix4 {
  const { steps, size } = volume.header.texture;
  const sides = steps.map((step, axis) => new Vector3(...step).multiplyScalar(size[axis]));
  let farthest = 0;
  for (const y of [-1, 1]) {
    for (const z of [-1, 1]) {
      const corner = sides[0].clone().addScaledVector(sides[1], y).addScaledVector(sides[2], z);
      farthest = Math.max(farthest, 0.5 * corner.length());
    }
  }
  for (const side of sides) side.divideScalar(farthest || 1);
  return new Matrix4().makeBasis(sides[0], sides[1], sides[2]);
}

function textureOf(
  data: Uint16Array,
  size: readonly number[],
  format: typeof RedFormat | typeof RGFormat,
  filter: typeof LinearFilter | typeof NearestFilter,
): Data3DTexture {
  const texture = new Data3DTexture(data, size[0], size[1], size[2]);
  texture.format = format;
  texture.type = HalfFloatType;
  texture.minFilter = filter;
  texture.magFilter = filter;
  texture.unpackAlignment = 2;
  texture.needsUpdate = true;
  return texture;
}

/** The parts of no fog and of most fog. */
function fogRange(volume: Volume): [number, number] {
  const { background, inside } = volume.header;
  if (volume.header.grid.class === "level set") {
    // As thick as can be from one sample's distance inside on.
    const zero = volume.partOf(0);
    const inner = volume.partOf(inside === "below" ? -0.5 * Math.abs(background) : 0.5 * Math.abs(background));
    return [zero, inner];
  }
  const none = Math.min(1, Math.max(0, volume.partOf(background)));
  return [none, none > 0.5 ? 0 : 1];
}

export class SpaceView {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(30, 1, 0.01, 100);
  private readonly orbit: OrbitControls;
  private readonly box: Mesh<BoxGeometry, ShaderMaterial>;
  private readonly frame: LineSegments<EdgesGeometry, LineBasicMaterial>;
  private readonly planes: LineLoop<BufferGeometry, LineBasicMaterial>[] = [];
  private readonly toScene: Matrix4;
  private wanted = 0;
  private moved = 0;
  private rest = 0;
  private isFast = false;
  private isTimed = false;
  /** Called when the view has turned. */
  onTurn: (toScreen: Matrix4) => void = () => {};

  /** Throws if there is no WebGL 2. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly volume: Volume,
  ) {
    const context = canvas.getContext("webgl2", { alpha: true, antialias: true, premultipliedAlpha: true });
    if (!context) throw new Error("This browser offers no WebGL 2, so the volume cannot be shown in space.");
    const largest = context.getParameter(context.MAX_3D_TEXTURE_SIZE) as number;
    if (Math.max(...volume.size) > largest) {
      throw new Error(
        `This browser takes no volumes of more than ${largest} samples a side; this one has ` +
          `${Math.max(...volume.size)}. A page made with --size ${largest} can be shown.`,
      );
    }
    this.renderer = new WebGLRenderer({ canvas, context, alpha: true });
    this.renderer.setClearAlpha(0);
    this.toScene = boxToScene(volume);
    this.box = this.makeBox();
    this.frame = new LineSegments(new EdgesGeometry(new BoxGeometry(1, 1, 1)), new LineBasicMaterial({ transparent: true, opacity: 0.35 }));
    for (const thing of [this.box, this.frame]) this.put(thing);
    this.frame.renderOrder = 1;
    for (let axis = 0; axis < 3; ++axis) this.planes.push(this.makePlane(axis));

    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableDamping = false;
    this.orbit.minDistance = 1.2;
    this.orbit.maxDistance = 20;
    this.orbit.addEventListener("change", () => this.draw(true));
    this.resetCamera();
    canvas.addEventListener("keydown", (event) => this.onKey(event));
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => this.draw(false));
    new ResizeObserver(() => this.draw(false)).observe(canvas);
  }

  /** Takes what is set on, and draws. */
  set(settings: Settings): void {
    const { uniforms } = this.box.material;
    uniforms.uIso.value = this.volume.partOf(settings.iso);
    // Whatever the background is not lies inside.
    uniforms.uInside.value = this.volume.header.background > settings.iso ? -1 : 1;
    uniforms.uFog.value = settings.fog;
    uniforms.uThickness.value = settings.thickness;
    this.planes.forEach((plane, axis) => {
      plane.visible = settings.planes;
      plane.position.set(0, 0, 0);
      const place = (settings.slices[axis] + 0.5) / this.volume.size[axis] - 0.5;
      const along = new Vector3().setFromMatrixColumn(this.toScene, axis);
      plane.matrix.copy(this.toScene).setPosition(along.multiplyScalar(place));
      plane.matrixWorldNeedsUpdate = true;
    });
    this.draw(false);
  }

  /** Takes the colours of the page on. */
  setColors(surface: string, inner: string, frame: string): void {
    this.box.material.uniforms.uColor.value.set(surface);
    this.box.material.uniforms.uInner.value.set(inner);
    this.frame.material.color.set(frame);
    this.draw(false);
  }

  resetCamera(): void {
    this.camera.position.setFromSpherical(new Spherical(3.6, 1.2, 0.55));
    this.orbit.target.set(0, 0, 0);
    this.orbit.update();
    this.draw(false);
  }

  private put(thing: Mesh | LineSegments): void {
    thing.matrixAutoUpdate = false;
    thing.matrix.copy(this.toScene);
    this.scene.add(thing);
  }

  private makeBox(): Mesh<BoxGeometry, ShaderMaterial> {
    const { volume } = this;
    const blocks = rangesOf(volume);
    const halves = Uint16Array.from(blocks.ranges, (value) => DataUtils.toHalfFloat(value));
    const toStep = this.toScene.clone().scale(new Vector3(1 / volume.size[0], 1 / volume.size[1], 1 / volume.size[2]));
    const stepToWorld = new Matrix3().setFromMatrix4(toStep);
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      side: BackSide,
      transparent: true,
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendDst: OneMinusSrcAlphaFactor,
      uniforms: {
        uVolume: { value: textureOf(volume.halves, volume.size, RedFormat, LinearFilter) },
        uBlocks: { value: textureOf(halves, blocks.size, RGFormat, NearestFilter) },
        uSize: { value: new Vector3(...volume.size) },
        uEye: { value: new Vector3() },
        uStepToWorld: { value: stepToWorld },
        uSlopeToWorld: { value: stepToWorld.clone().invert().transpose() },
        uToClip: { value: new Matrix4() },
        uIso: { value: 0.5 },
        uInside: { value: 1 },
        uFog: { value: false },
        uFogRange: { value: new Vector2(...fogRange(volume)) },
        uThickness: { value: 10 },
        uLight: { value: new Vector3() },
        uSky: { value: new Vector3(0, 1, 0) },
        uColor: { value: new Color() },
        uInner: { value: new Color() },
      },
    });
    return new Mesh(new BoxGeometry(1, 1, 1), material);
  }

  private makePlane(axis: number): LineLoop<BufferGeometry, LineBasicMaterial> {
    const corners: number[] = [];
    for (const [a, b] of [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) {
      const corner = [0, 0, 0];
      corner[(axis + 1) % 3] = a;
      corner[(axis + 2) % 3] = b;
      corners.push(...corner);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(corners, 3));
    const plane = new LineLoop(geometry, new LineBasicMaterial({ color: kAxisColors[axis], transparent: true, opacity: 0.9 }));
    plane.renderOrder = 2;
    plane.matrixAutoUpdate = false;
    this.scene.add(plane);
    return plane;
  }

  private onKey(event: KeyboardEvent): void {
    const turn = 0.12;
    const place = new Spherical().setFromVector3(this.camera.position.clone().sub(this.orbit.target));
    switch (event.key) {
      case "ArrowLeft": place.theta -= turn; break;
      case "ArrowRight": place.theta += turn; break;
      case "ArrowUp": place.phi -= turn; break;
      case "ArrowDown": place.phi += turn; break;
      case "+": case "=": place.radius *= 0.9; break;
      case "-": place.radius /= 0.9; break;
      case "0": case "Home": this.resetCamera(); event.preventDefault(); return;
      default: return;
    }
    event.preventDefault();
    place.radius = Math.min(this.orbit.maxDistance, Math.max(this.orbit.minDistance, place.radius));
    this.camera.position.setFromSpherical(place.makeSafe()).add(this.orbit.target);
    this.orbit.update();
    this.draw(true);
  }

  /** Draws in the browser's next frame; coarsely while things move. */
  private draw(moving: boolean): void {
    if (moving) {
      this.moved = performance.now();
      window.clearTimeout(this.rest);
      this.rest = window.setTimeout(() => this.draw(false), kRestMilliseconds);
    }
    if (this.wanted) return;
    this.wanted = requestAnimationFrame(() => {
      this.wanted = 0;
      this.drawNow(performance.now() - this.moved < kRestMilliseconds);
    });
  }

  private drawNow(moving: boolean): void {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    const coarse = moving && !this.isFast;
    const most = Math.sqrt((coarse ? kMovingPixels : kMostPixels) / (width * height));
    const wanted = this.isFast ? Math.max(2, window.devicePixelRatio) : window.devicePixelRatio;
    this.renderer.setPixelRatio(Math.min(wanted, most));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // All of it is seen in a high window as in a wide one.
    const fit = Math.tan((30 * Math.PI) / 360);
    this.camera.fov = (360 / Math.PI) * Math.atan(fit * Math.max(1, 1 / this.camera.aspect));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();

    const { uniforms } = this.box.material;
    const toBox = this.toScene.clone().invert();
    uniforms.uEye.value
      .copy(this.camera.position)
      .applyMatrix4(toBox)
      .addScalar(0.5)
      .multiply(uniforms.uSize.value);
    uniforms.uToClip.value
      .multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse)
      .multiply(this.toScene);
    uniforms.uLight.value.set(-0.55, 0.75, 0.75).normalize().transformDirection(this.camera.matrixWorld);
    this.renderer.render(this.scene, this.camera);
    this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? "0") + 1);
    this.canvas.dataset.coarse = String(moving);
    this.onTurn(this.camera.matrixWorldInverse);
    // The first picture waits for programs and textures.
    if (!this.isTimed && Number(this.canvas.dataset.drawn) > 1) this.timePicture();
  }

  /** Finds out whether this machine is fast, and then draws with more pixels. */
  private timePicture(): void {
    const context = this.renderer.getContext() as WebGL2RenderingContext;
    const sync = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!sync) return;
    this.isTimed = true;
    context.flush();
    const start = performance.now();
    const look = () => {
      const state = context.clientWaitSync(sync, 0, 0);
      const time = performance.now() - start;
      if (state === context.TIMEOUT_EXPIRED && time < kFastMilliseconds) {
        window.setTimeout(look, 2);
        return;
      }
      this.isFast = state !== context.TIMEOUT_EXPIRED && state !== context.WAIT_FAILED && time < kFastMilliseconds;
      context.deleteSync(sync);
      if (this.isFast) this.draw(false);
    };
    look();
  }
}
