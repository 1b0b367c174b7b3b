// What the page is given: a header in JSON, and a box of samples.

export type Vec3 = [number, number, number];

/** What the command writes; see viewHeader in apps/bandvox/view_page.h. */
export interface Header {
  version: string;
  title: string;
  file: string;
  iso: number;
  /** Where values are inside of the iso-value above. */
  inside: "above" | "below";
  background: number;
  texture: {
    size: Vec3;
    low: number;
    high: number;
    /** Voxels between samples. */
    spacing: Vec3;
    /** Index space, of the first sample. */
    first: Vec3;
    /** World, of the middle of all samples. */
    center: Vec3;
    /** World, from a sample to the next along each axis. */
    steps: [Vec3, Vec3, Vec3];
    linear: boolean;
    not_finite: number;
  };
  histogram: { low: number; high: number; active: number[]; inactive: number[] };
  spectrum: { block_side: number; blocks: number; power: number[] };
  grid: GridReport;
}

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

export interface GridReport {
  name: string;
  class: string;
  value_type: string;
  voxel_size: Vec3;
  index_bounds: { min: Vec3; max: Vec3 } | null;
  world_bounds: { min: Vec3; max: Vec3 } | null;
  active_voxels: number;
  active_tiles: number;
  memory_bytes: number;
  half: boolean;
  compression?: string;
  bandvox?: { [key: string]: Json };
  metadata: { [key: string]: Json };
}

export class Volume {
  /** Parts of the way from the lowest value to the highest, 0 to 1. */
  readonly parts: Float32Array;

  constructor(
    readonly header: Header,
    /** The same as 16-bit floats. */
    readonly halves: Uint16Array,
  ) {
    this.parts = new Float32Array(halves.length);
    const table = halfTable();
    for (let i = 0; i < halves.length; ++i) this.parts[i] = table[halves[i]];
  }

  get size(): Vec3 {
    return this.header.texture.size;
  }

  get range(): number {
    return this.header.texture.high - this.header.texture.low;
  }

  partOf(value: number): number {
    return this.range > 0 ? (value - this.header.texture.low) / this.range : 0;
  }

  valueOf(part: number): number {
    return this.header.texture.low + part * this.range;
  }
}

/** The floats of all 16-bit patterns. */
function halfTable(): Float32Array {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31;
    const fraction = bits & 1023;
    const size =
      exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    table[bits] = bits & 0x8000 ? -size : size;
  }
  return table;
}

function fromBase64(text: string): Uint8Array {
  const clean = text.trim();
  const padding = clean.endsWith("==") ? 2 : clean.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array((clean.length / 4) * 3 - padding);
  // In pieces, for the sake of memory.
  const piece = 1 << 20;
  let at = 0;
  for (let i = 0; i < clean.length; i += piece) {
    const some = atob(clean.slice(i, i + piece));
    for (let j = 0; j < some.length; ++j) bytes[at++] = some.charCodeAt(j);
  }
  return bytes;
}

async function inflated(bytes: Uint8Array): Promise<Uint8Array> {
  if (!("DecompressionStream" in window)) {
    throw new Error("This browser cannot unpack the volume: it has no DecompressionStream.");
  }
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function textOf(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

/** Takes the volume out of the page. */
export async function readVolume(): Promise<Volume> {
  const header = JSON.parse(textOf("volume-header")) as Header;
  const bytes = await inflated(fromBase64(textOf("volume-texture")));
  const count = header.texture.size[0] * header.texture.size[1] * header.texture.size[2];
  if (bytes.length !== 2 * count) {
    throw new Error(`The volume is damaged: ${bytes.length} bytes instead of ${2 * count}.`);
  }
  const halves = new Uint16Array(count);
  for (let i = 0; i < count; ++i) halves[i] = bytes[i] | (bytes[count + i] << 8);
  return new Volume(header, halves);
}
