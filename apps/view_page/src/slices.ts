// Slices through the samples, in grey, with the iso-contour.
import { contour, type Picture } from "./contour";
import { kAxisColors, kAxisNames, type Settings } from "./settings";
import type { Volume } from "./volume";
import { element, numberInWords } from "./words";

/** Axes to the right and upward of the slice across each axis. */
const kAcross: [number, number][] = [[2, 1], [0, 2], [0, 1]];

export class Slices {
  private readonly canvases: HTMLCanvasElement[] = [];
  private readonly sliders: HTMLInputElement[] = [];
  private readonly outputs: HTMLOutputElement[] = [];
  private readonly grey = document.createElement("canvas");

  constructor(
    private readonly volume: Volume,
    private readonly settings: Settings,
    place: HTMLElement,
    onChange: () => void,
  ) {
    kAxisNames.forEach((name, axis) => place.append(this.makeFigure(name, axis, onChange)));
    new ResizeObserver(() => this.draw()).observe(place);
  }

  private makeFigure(name: string, axis: number, onChange: () => void): HTMLElement {
    const [right, up] = kAcross[axis];
    const canvas = element("canvas", {
      role: "img",
      "aria-label": `Slice across ${name}: ${kAxisNames[right]} to the right, ${kAxisNames[up]} upward`,
    });
    const slider = element("input", {
      type: "range",
      id: `slice-${name}`,
      min: "0",
      max: String(this.volume.size[axis] - 1),
      step: "1",
      value: String(this.settings.slices[axis]),
    });
    const output = element("output", { for: `slice-${name}` });
    slider.addEventListener("input", () => {
      this.settings.slices[axis] = Number(slider.value);
      onChange();
    });
    this.canvases.push(canvas);
    this.sliders.push(slider);
    this.outputs.push(output);
    const heading = element("span", { class: "axis" }, `${name}`);
    heading.style.color = kAxisColors[axis];
    return element(
      "figure",
      { class: "panel slice" },
      element("div", { class: "slice-picture" }, canvas),
      element("label", { class: "slider", for: `slice-${name}` }, heading, slider, output),
    );
  }

  reset(): void {
    this.sliders.forEach((slider, axis) => (slider.value = String(this.settings.slices[axis])));
  }

  draw(): void {
    for (let axis = 0; axis < 3; ++axis) {
      this.drawSlice(axis);
      this.outputs[axis].value = this.placeInWords(axis);
    }
  }

  /** In the world where the axis is one of the world's, and in voxels otherwise. */
  private placeInWords(axis: number): string {
    const { texture } = this.volume.header;
    const place = this.settings.slices[axis];
    const step = texture.steps[axis];
    const isWorlds = step.every((part, a) => a === axis || Math.abs(part) < 1e-9 * Math.abs(step[axis]));
    if (!isWorlds || !texture.linear) {
      return `voxel ${numberInWords(texture.first[axis] + place * texture.spacing[axis])}`;
    }
    return numberInWords(texture.center[axis] + (place - 0.5 * (this.volume.size[axis] - 1)) * step[axis]);
  }

  private pictureOf(axis: number): Picture {
    const [right, up] = kAcross[axis];
    const { size, parts } = this.volume;
    const strides = [1, size[0], size[0] * size[1]];
    const width = size[right];
    const height = size[up];
    const values = new Float32Array(width * height);
    const from = this.settings.slices[axis] * strides[axis];
    for (let row = 0; row < height; ++row) {
      // The first row is the highest.
      const start = from + (height - 1 - row) * strides[up];
      for (let column = 0; column < width; ++column) {
        values[row * width + column] = parts[start + column * strides[right]];
      }
    }
    return { width, height, values };
  }

  private drawSlice(axis: number): void {
    const canvas = this.canvases[axis];
    const [right, up] = kAcross[axis];
    const picture = this.pictureOf(axis);
    const length = (a: number) => Math.hypot(...this.volume.header.texture.steps[a]) * this.volume.size[a];
    const room = canvas.parentElement as HTMLElement;
    if (room.clientWidth === 0) return;
    const scale = Math.min(room.clientWidth / length(right), room.clientHeight / length(up));
    const width = Math.max(1, scale * length(right));
    const height = Math.max(1, scale * length(up));
    const density = Math.max(1, window.devicePixelRatio);
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
    const context = canvas.getContext("2d");
    if (!context) return;
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = "high";
    context.drawImage(this.greyOf(picture), 0, 0, canvas.width, canvas.height);

    // A sample's place is its pixel's middle.
    const sx = canvas.width / picture.width;
    const sy = canvas.height / picture.height;
    context.beginPath();
    contour(picture, this.volume.partOf(this.settings.iso), (x0, y0, x1, y1) => {
      context.moveTo((x0 + 0.5) * sx, (y0 + 0.5) * sy);
      context.lineTo((x1 + 0.5) * sx, (y1 + 0.5) * sy);
    });
    context.lineWidth = 1.4 * density;
    context.lineCap = "round";
    context.strokeStyle = getComputedStyle(canvas).getPropertyValue("--iso");
    context.stroke();
  }

  private greyOf(picture: Picture): HTMLCanvasElement {
    this.grey.width = picture.width;
    this.grey.height = picture.height;
    const context = this.grey.getContext("2d");
    if (!context) return this.grey;
    const image = context.createImageData(picture.width, picture.height);
    for (let i = 0; i < picture.values.length; ++i) {
      const shade = 255 * Math.min(1, Math.max(0, picture.values[i]));
      image.data.set([shade, shade, shade, 255], 4 * i);
    }
    context.putImageData(image, 0, 0);
    return this.grey;
  }
}
