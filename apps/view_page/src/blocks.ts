// The range of values in blocks of samples, so that rays can pass over what they do not see.
import type { Volume } from "./volume";

export const kBlock = 8;

export interface Blocks {
  size: [number, number, number];
  /** Least and most of each block, x fastest. */
  ranges: Float32Array;
}

/** What interpolation can reach in a block: its samples, and the next on each side. */
export function rangesOf(volume: Volume): Blocks {
  const [nx, ny, nz] = volume.size;
  const size: [number, number, number] = [
    Math.ceil(nx / kBlock),
    Math.ceil(ny / kBlock),
    Math.ceil(nz / kBlock),
  ];
  const ranges = new Float32Array(2 * size[0] * size[1] * size[2]);
  let at = 0;
  for (let bz = 0; bz < size[2]; ++bz) {
    for (let by = 0; by < size[1]; ++by) {
      for (let bx = 0; bx < size[0]; ++bx) {
        let low = Infinity;
        let high = -Infinity;
        const z1 = Math.min(nz - 1, (bz + 1) * kBlock);
        const y1 = Math.min(ny - 1, (by + 1) * kBlock);
        const x1 = Math.min(nx - 1, (bx + 1) * kBlock);
        for (let z = Math.max(0, bz * kBlock - 1); z <= z1; ++z) {
          for (let y = Math.max(0, by * kBlock - 1); y <= y1; ++y) {
            const row = (z * ny + y) * nx;
            for (let x = Math.max(0, bx * kBlock - 1); x <= x1; ++x) {
              const part = volume.parts[row + x];
              if (part < low) low = part;
              if (part > high) high = part;
            }
          }
        }
        // Room for what rounding to 16 bits does to them.
        ranges[at++] = low - 1e-3 * Math.abs(low);
        ranges[at++] = high + 1e-3 * Math.abs(high);
      }
    }
  }
  return { size, ranges };
}
