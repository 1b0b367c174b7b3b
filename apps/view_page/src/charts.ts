// The histogram and the spectrum, drawn as SVG.
import type { Volume } from "./volume";
import { drawing, element, numberInWords } from "./words";

const kWidth = 380;
const kHeight = 176;
const kLeft = 40;
const kRight = 10;
const kTop = 16;
const kBottom = 30;
const kInnerWidth = kWidth - kLeft - kRight;
const kInnerHeight = kHeight - kTop - kBottom;

function chart(label: string): SVGElement {
  return drawing("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, class: "chart", role: "img", "aria-label": label });
}

const text = (x: number, y: number, words: string, anchor: string, style = "tick") =>
  drawing("text", { x, y, "text-anchor": anchor, class: style }, words);

const line = (x0: number, y0: number, x1: number, y1: number, style: string) =>
  drawing("line", { x1: x0, y1: y0, x2: x1, y2: y1, class: style });

function legend(...entries: [string, string][]): HTMLElement {
  const list = element("ul", { class: "legend" });
  for (const [style, words] of entries) list.append(element("li", {}, element("i", { class: style }), words));
  return list;
}

export class Histogram {
  private readonly mark = line(0, kTop, 0, kTop + kInnerHeight, "iso-line");
  private readonly markText = text(0, kTop - 5, "", "middle", "tick iso-text");

  constructor(
    private readonly volume: Volume,
    place: HTMLElement,
  ) {
    const { low, high, active, inactive } = volume.header.histogram;
    const svg = chart(
      `Histogram of ${active.length} bins from ${numberInWords(low)} to ${numberInWords(high)}, counts on a logarithmic scale`,
    );
    const most = Math.max(1, ...active, ...inactive);
    const top = Math.max(1, Math.ceil(Math.log10(most)));
    const y = (count: number) =>
      kTop + kInnerHeight * (1 - (count > 0 ? (Math.log10(count) + 0.3) / (top + 0.3) : 0));
    const every = Math.max(1, Math.ceil(top / 4));
    for (let power = 0; power <= top; power += every) {
      const at = y(10 ** power);
      svg.append(line(kLeft, at, kWidth - kRight, at, "rule"));
      svg.append(text(kLeft - 6, at + 3.5, power < 4 ? String(10 ** power) : `1e${power}`, "end"));
    }
    const bars = (counts: number[], style: string) => {
      let path = "";
      const width = kInnerWidth / counts.length;
      counts.forEach((count, bin) => {
        if (!(count > 0)) return;
        const height = kTop + kInnerHeight - y(count);
        path += `M${(kLeft + bin * width).toFixed(2)} ${y(count).toFixed(2)}h${width.toFixed(2)}v${height.toFixed(2)}h${(-width).toFixed(2)}z`;
      });
      svg.append(drawing("path", { d: path, class: style }));
    };
    bars(inactive, "bar-inactive");
    bars(active, "bar-active");
    svg.append(line(kLeft, kTop + kInnerHeight, kWidth - kRight, kTop + kInnerHeight, "base"));
    for (const [x, value, anchor] of [[kLeft, low, "start"], [kLeft + kInnerWidth / 2, (low + high) / 2, "middle"], [kWidth - kRight, high, "end"]] as const) {
      svg.append(text(x, kHeight - kBottom + 14, numberInWords(value, 3), anchor));
    }
    svg.append(text(kLeft + kInnerWidth / 2, kHeight - 3, "value", "middle", "tick label"));
    svg.append(this.mark, this.markText);
    place.append(svg, legend(["bar-active", "active voxels"], ["bar-inactive", "inactive voxels of the box"], ["iso-line", "iso-value"]));
  }

  setIso(iso: number): void {
    const { low, high } = this.volume.header.histogram;
    const part = high > low ? (iso - low) / (high - low) : 0;
    const x = String(kLeft + kInnerWidth * Math.min(1, Math.max(0, part)));
    this.mark.setAttribute("x1", x);
    this.mark.setAttribute("x2", x);
    this.markText.setAttribute("x", x);
    this.markText.textContent = numberInWords(iso, 3);
  }
}

/** Draws the spectrum, with what the filter leaves of a solid. */
export function drawSpectrum(volume: Volume, place: HTMLElement): void {
  const { power, block_side, blocks } = volume.header.spectrum;
  const loudest = Math.max(...power);
  if (blocks === 0 || !(loudest > 0)) {
    place.append(element("p", { class: "quiet" }, "There is nothing to measure: the grid is constant wherever it has leaf nodes."));
    return;
  }
  const frequency = (shell: number) => shell / block_side;
  const decibels = power.map((p) => 10 * Math.log10(p / loudest));
  const least = Math.min(...decibels.filter(Number.isFinite));
  const floor = Math.max(-160, Math.floor(Math.min(-20, least) / 20) * 20);
  const highest = Math.sqrt(0.75);
  const x = (k: number) => kLeft + (kInnerWidth * k) / highest;
  const y = (level: number) => kTop + kInnerHeight * Math.min(1, Math.max(0, level / floor));

  const own = volume.header.grid.bandvox ?? {};
  const cutoff = Number(own["cutoff"] ?? NaN);
  const order = Number(own["order"] ?? NaN);
  const isFiltered = cutoff > 0 && order > 0;
  const svg = chart(
    `Power over frequency: falls from 0 to ${numberInWords(decibels[block_side / 2] ?? 0, 3)} decibels at the Nyquist frequency` +
      (isFiltered ? `; the filter's cutoff is ${cutoff} cycles per voxel` : ""),
  );
  svg.append(drawing("rect", { x: x(0.5), y: kTop, width: x(highest) - x(0.5), height: kInnerHeight, class: "beyond" }));
  const step = floor < -80 ? 40 : 20;
  for (let level = 0; level >= floor; level -= step) {
    svg.append(line(kLeft, y(level), kWidth - kRight, y(level), "rule"));
    svg.append(text(kLeft - 6, y(level) + 3.5, String(level).replace("-", "−"), "end"));
  }
  for (const k of [0, 0.1, 0.2, 0.3, 0.4, 0.5]) svg.append(text(x(k), kHeight - kBottom + 14, String(k), "middle"));
  svg.append(text(x((0.5 + highest) / 2), kHeight - kBottom + 14, "corners", "middle"));
  svg.append(line(kLeft, kTop + kInnerHeight, kWidth - kRight, kTop + kInnerHeight, "base"));
  svg.append(text(kLeft + kInnerWidth / 2, kHeight - 3, "cycles per voxel", "middle", "tick label"));

  const path = (levels: number[], style: string) => {
    let d = "";
    levels.forEach((level, shell) => {
      if (shell === 0 || !Number.isFinite(level)) return;
      if (level < floor) return;
      d += `${d ? "L" : "M"}${x(frequency(shell)).toFixed(2)} ${y(level).toFixed(2)}`;
    });
    svg.append(drawing("path", { d, class: style }));
  };
  if (isFiltered) {
    const expected = expectedLevels(decibels, frequency, order, cutoff);
    path(expected, "expected");
    svg.append(line(x(cutoff), kTop, x(cutoff), kTop + kInnerHeight, "cutoff"));
    svg.append(text(x(cutoff), kTop - 5, `cutoff ${cutoff}`, "middle", "tick cutoff-text"));
  }
  svg.append(line(x(0.5), kTop, x(0.5), kTop + kInnerHeight, "nyquist"));
  svg.append(text(x(0.5), kTop - 5, "Nyquist", "middle"));
  path(decibels, "measured");
  place.append(svg);
  const entries: [string, string][] = [["measured", "measured, dB"]];
  if (isFiltered) entries.push(["expected", "a solid under this filter, k⁻⁴ H(k)²"]);
  place.append(legend(...entries));
  place.append(
    element("p", { class: "quiet small" }, `Mean over ${blocks} ${blocks === 1 ? "block" : "blocks"} of ${block_side}³ voxels and over all directions.`),
  );
}

/** What a solid's sharp surface, whose power falls as k⁻⁴, becomes under the filter; as loud as what
 *  was measured up to the cutoff. */
function expectedLevels(decibels: number[], frequency: (shell: number) => number, order: number, cutoff: number): number[] {
  const shape = decibels.map((_, shell) => {
    const k = frequency(shell);
    return k > 0 ? (10 / Math.LN10) * (-4 * Math.log(k) - 2 * (k / cutoff) ** order) : NaN;
  });
  let sum = 0;
  let count = 0;
  for (let shell = 4; shell < decibels.length && frequency(shell) <= cutoff; ++shell) {
    sum += decibels[shell] - shape[shell];
    ++count;
  }
  const shift = count > 0 ? sum / count : decibels[1] - shape[1];
  return shape.map((level) => level + shift);
}
