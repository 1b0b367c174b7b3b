// Where a picture of values crosses one, as segments: marching squares, with saddles decided by the
// mean of their corners.

export interface Picture {
  width: number;
  height: number;
  values: Float32Array;
}

/** Calls `segment` with both ends; a value at column i lies at i. */
export function contour(
  picture: Picture,
  level: number,
  segment: (x0: number, y0: number, x1: number, y1: number) => void,
): void {
  const { width, height, values } = picture;
  const cross = (a: number, b: number) => (level - a) / (b - a);
  for (let y = 0; y + 1 < height; ++y) {
    for (let x = 0; x + 1 < width; ++x) {
      const at = y * width + x;
      const a = values[at];
      const b = values[at + 1];
      const c = values[at + width + 1];
      const d = values[at + width];
      const kind = (a > level ? 1 : 0) | (b > level ? 2 : 0) | (c > level ? 4 : 0) | (d > level ? 8 : 0);
      if (kind === 0 || kind === 15) continue;
      // Ends on the four sides, where there are any.
      const top = (): [number, number] => [x + cross(a, b), y];
      const right = (): [number, number] => [x + 1, y + cross(b, c)];
      const bottom = (): [number, number] => [x + cross(d, c), y + 1];
      const left = (): [number, number] => [x, y + cross(a, d)];
      const join = (p: [number, number], q: [number, number]) => segment(p[0], p[1], q[0], q[1]);
      const middleAbove = (a + b + c + d) / 4 > level;
      switch (kind) {
        case 1: case 14: join(left(), top()); break;
        case 2: case 13: join(top(), right()); break;
        case 4: case 11: join(right(), bottom()); break;
        case 8: case 7: join(bottom(), left()); break;
        case 3: case 12: join(left(), right()); break;
        case 6: case 9: join(top(), bottom()); break;
        case 5:
          if (middleAbove) { join(top(), right()); join(bottom(), left()); }
          else { join(left(), top()); join(right(), bottom()); }
          break;
        case 10:
          if (middleAbove) { join(left(), top()); join(right(), bottom()); }
          else { join(top(), right()); join(bottom(), left()); }
          break;
      }
    }
  }
}
