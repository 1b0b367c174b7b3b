/** What the visitor chooses. */
export interface Settings {
  /** In the grid's values. */
  iso: number;
  fog: boolean;
  /** Extinction of full fog per half diagonal of the box. */
  thickness: number;
  planes: boolean;
  /** Samples, one for each axis. */
  slices: [number, number, number];
}

export const kAxisNames = ["x", "y", "z"] as const;
/** Of x, y and z, on light ground and on dark. */
export const kAxisColors = ["#cf5a4a", "#4f9a4a", "#4a78cf"] as const;
