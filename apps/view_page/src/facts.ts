// What the grid says of itself: its errors, and its size.
import type { Json, Volume } from "./volume";
import { bytesInWords, countInWords, drawing, element, numberInWords, vectorInWords } from "./words";

function list(entries: [string, string | Node][]): HTMLElement {
  const made = element("dl");
  for (const [name, value] of entries) made.append(element("div", {}, element("dt", {}, name), element("dd", {}, value)));
  return made;
}

const kScaleLow = -9;
const kSampling = "Sampling, measured";

/** An error beside the tolerance, on a logarithmic scale from 1e-9 to 1. */
function meter(value: number, tolerance: number, isBound: boolean): SVGElement {
  const place = (v: number) => 100 * Math.min(1, Math.max(0.015, 1 - Math.log10(Math.max(v, 1e-300)) / kScaleLow));
  const svg = drawing("svg", { viewBox: "0 0 100 8", class: "meter", "aria-hidden": "true", preserveAspectRatio: "none" });
  svg.append(drawing("rect", { x: 0, y: 2, width: 100, height: 4, rx: 2, class: "meter-ground" }));
  if (value > 0) {
    svg.append(drawing("rect", { x: 0, y: 2, width: place(value), height: 4, rx: 2, class: !isBound ? "meter-plain" : value <= tolerance ? "meter-good" : "meter-bad" }));
  }
  if (tolerance > 0) svg.append(drawing("rect", { x: place(tolerance) - 0.4, y: 0, width: 0.8, height: 8, class: "meter-mark" }));
  return svg;
}

const numberOf = (value: Json | undefined) => (typeof value === "number" ? value : NaN);

/** What the measured error means beside the tolerance, which leaves that of sampling apart. */
function verdict(route: string, measured: number, bound: number): HTMLElement {
  const say = (kind: string, words: string) => element("p", { class: `verdict ${kind}` }, words);
  const found = numberInWords(measured, 2);
  const limit = numberInWords(bound, 2);
  if (route !== "exact") {
    return Number.isFinite(measured)
      ? say("", `Sampling changed the density by ${found}; the tolerance of ${limit} is for all else.`)
      : say("", "What sampling did to the density was not measured.");
  }
  if (!Number.isFinite(measured)) return say("", "The error was not measured.");
  return measured <= bound
    ? say("good", `The measured error is ${found}, within the tolerance of ${limit}.`)
    : say("bad", `The measured error is ${found}, above the tolerance of ${limit}.`);
}

export function showBudget(volume: Volume, place: HTMLElement): void {
  const own = volume.header.grid.bandvox;
  const order = numberOf(own?.["order"]);
  const cutoff = numberOf(own?.["cutoff"]);
  if (!own || !(order > 0) || !(cutoff > 0)) {
    place.append(element("p", {}, "This grid says nothing of its errors: it was not made by bandvox convert."));
    if (own?.["source"]) place.append(list([["Made from", String(own["source"])]]));
    return;
  }
  const route = String(own["route"] ?? "exact");
  const tolerance = numberOf(own["tolerance"]);
  const atNyquist = Math.exp(-((0.5 / cutoff) ** order));
  // No lattice can be better than what the filter leaves beyond it.
  const bound = Math.max(tolerance, atNyquist);
  const errors: [string, number, string][] = [];
  if (route === "exact") errors.push(["Closure, measured", numberOf(own["closure_error"]), "How far densities away from the surface were from whole numbers"]);
  else errors.push([kSampling, numberOf(own["sampling_error"]), "What taking samples of the solid did to the density"]);
  const storage = numberOf(own["storage_error"]);
  errors.push(["Storage", storage, "The largest change by rounding to 16 bits; 0 of floats"]);
  errors.push(["Left at Nyquist, H(½)", atNyquist, "What the filter lets pass where the lattice ends"]);

  place.append(verdict(route, errors[0][1], bound));
  const table = element("table", { class: "errors" });
  table.append(element("caption", { class: "hidden" }, "Errors of the density, full density being 1"));
  const row = (name: string, value: number, title: string, withMeter: boolean) => {
    const cells = element("tr", { title }, element("th", { scope: "row" }, name), element("td", { class: "number" }, Number.isFinite(value) ? numberInWords(value, 3) : "not known"));
    const last = element("td", { class: "meter-cell" });
    if (withMeter && Number.isFinite(value)) last.append(meter(value, bound, name !== kSampling));
    cells.append(last);
    return cells;
  };
  const body = element("tbody");
  body.append(row("Tolerance asked for", tolerance, "The error that was asked for, density", false));
  for (const [name, value, title] of errors) body.append(row(name, value, title, true));
  table.append(body);
  place.append(table);

  const source = numberOf(own["source_volume"]);
  const grid = numberOf(own["grid_volume"]);
  const entries: [string, string][] = [];
  if (source > 0) entries.push(["Volume of the source", numberInWords(source, 8)]);
  entries.push(["Volume of the grid", numberInWords(grid, 8)]);
  if (source > 0) {
    const off = (grid - source) / source;
    entries.push(["Difference", off === 0 ? "none" : `${off > 0 ? "+" : ""}${numberInWords(off, 2)} of it`]);
  }
  entries.push(["Filter", `order ${numberInWords(order)}, cutoff ${numberInWords(cutoff)}`]);
  const oversampling = numberOf(own["oversampling"]);
  entries.push(["Route", route + (route !== "exact" && oversampling > 0 ? `, ${numberInWords(oversampling)} to a voxel` : "")]);
  const holes = numberOf(own["holes_capped"]);
  if (holes > 0) entries.push(["Holes capped", countInWords(holes)]);
  if (own["clamped"] === true) entries.push(["Clamped", "to 0 … 1"]);
  place.append(list(entries));
}

function jsonInWords(value: Json): string {
  if (typeof value === "number") return numberInWords(value, 6);
  if (typeof value === "string") return value;
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return value.map(jsonInWords).join(", ");
  return value === null ? "not known" : JSON.stringify(value);
}

export function showGrid(volume: Volume, place: HTMLElement): void {
  const { grid, texture } = volume.header;
  const entries: [string, string | Node][] = [];
  entries.push(["Name", grid.name || "without a name"]);
  const source = grid.bandvox?.["source"];
  if (source) entries.push(["Made from", String(source)]);
  entries.push(["Class", `${grid.class}, ${grid.value_type}${grid.half ? ", stored with 16 bits" : ""}`]);
  entries.push(["Voxel size", grid.voxel_size.every((v) => v === grid.voxel_size[0]) ? numberInWords(grid.voxel_size[0], 6) : vectorInWords(grid.voxel_size, 6)]);
  if (grid.index_bounds) {
    const { min, max } = grid.index_bounds;
    entries.push(["Voxels of the box", max.map((m, a) => countInWords(m - min[a] + 1)).join(" × ")]);
  }
  if (grid.world_bounds) {
    entries.push(["World box", element("span", {}, vectorInWords(grid.world_bounds.min, 5), element("br"), vectorInWords(grid.world_bounds.max, 5))]);
  }
  entries.push(["Active voxels", countInWords(grid.active_voxels)]);
  if (grid.active_tiles > 0) entries.push(["Active tiles", countInWords(grid.active_tiles)]);
  entries.push(["In memory", bytesInWords(grid.memory_bytes)]);
  if (grid.compression) entries.push(["Compression", grid.compression]);
  const coarsest = Math.max(...texture.spacing);
  entries.push([
    "Shown",
    `${texture.size.join(" × ")} samples` + (coarsest === 1 ? ", the voxels themselves" : `, means over ${numberInWords(coarsest, 3)} voxels`),
  ]);
  if (texture.not_finite > 0) entries.push(["Not finite", `${countInWords(texture.not_finite)}, shown as background`]);
  if (!texture.linear) entries.push(["Shape", "shown as a box: the grid's transform is not linear"]);
  place.append(list(entries));
  const others = Object.entries(grid.metadata);
  if (others.length > 0) {
    const more = element("details", {}, element("summary", {}, `Metadata (${others.length})`));
    more.append(list(others.map(([name, value]) => [name, jsonInWords(value)])));
    place.append(more);
  }
}
