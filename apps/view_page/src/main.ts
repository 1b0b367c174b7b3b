// The page of `bandvox view`: takes the volume out of itself, and shows it.
import "./style.css";
import { drawSpectrum, Histogram } from "./charts";
import { showBudget, showGrid } from "./facts";
import { kAxisColors, kAxisNames, type Settings } from "./settings";
import { Slices } from "./slices";
import { SpaceView } from "./space";
import { readVolume, type Volume } from "./volume";
import { byId, drawing, numberInWords } from "./words";

const kIsoSteps = 1000;

/** Slices through the middle. */
function middle(volume: Volume): [number, number, number] {
  return volume.size.map((n) => Math.floor((n - 1) / 2)) as [number, number, number];
}

/** Of a slider from 0 to 100; each tenth of it doubles. */
function thicknessOf(slider: number): number {
  return 12 * 2 ** ((slider - 50) / 10);
}

function trySpace(volume: Volume): SpaceView | null {
  try {
    return new SpaceView(byId<HTMLCanvasElement>("view-canvas"), volume);
  } catch (error) {
    const message = byId("view-message");
    message.textContent = `${error instanceof Error ? error.message : error} Slices, histogram and spectrum are below and beside this.`;
    message.hidden = false;
    byId("view-canvas").hidden = true;
    byId("triad").remove();
    for (const id of ["mode", "fog-control", "planes"]) (byId(id).closest("fieldset, label") as HTMLElement).hidden = true;
    return null;
  }
}

/** The grid's axes as the eye sees them. */
function turnTriad(volume: Volume, toEye: readonly number[]): void {
  const triad = byId<SVGElement>("triad");
  const axes = volume.header.texture.steps.map((step, axis) => {
    const length = Math.hypot(...step) || 1;
    const [x, y, z] = step.map((part) => part / length);
    const seen = [0, 1, 2].map((row) => toEye[row] * x + toEye[4 + row] * y + toEye[8 + row] * z);
    return { axis, seen };
  });
  axes.sort((a, b) => a.seen[2] - b.seen[2]);
  triad.replaceChildren(
    ...axes.flatMap(({ axis, seen }) => {
      const x = 22 * seen[0];
      const y = -22 * seen[1];
      return [
        drawing("line", { x1: 0, y1: 0, x2: x, y2: y, stroke: kAxisColors[axis] }),
        drawing("text", { x: 1.42 * x, y: 1.42 * y + 4, fill: kAxisColors[axis] }, kAxisNames[axis]),
      ];
    }),
  );
}

function start(volume: Volume): void {
  const { header } = volume;
  document.title = header.title;
  byId("title").textContent = header.title;
  byId("subtitle").textContent = `grid “${header.grid.name}” of ${header.file}`;
  byId("maker").textContent = `bandvox ${header.version}`;

  const settings: Settings = {
    iso: header.iso,
    fog: false,
    thickness: thicknessOf(50),
    planes: true,
    slices: middle(volume),
  };
  const space = trySpace(volume);
  const slices = new Slices(volume, settings, byId("slices"), () => update());
  const histogram = new Histogram(volume, byId("histogram"));
  drawSpectrum(volume, byId("spectrum"));
  showBudget(volume, byId("budget"));
  showGrid(volume, byId("about"));

  const iso = byId<HTMLInputElement>("iso");
  const fog = byId<HTMLInputElement>("fog");
  const planes = byId<HTMLInputElement>("planes");
  const modes = [...document.querySelectorAll<HTMLInputElement>("input[name=mode]")];
  const isoToSlider = () => (iso.value = String(Math.round(kIsoSteps * volume.partOf(settings.iso))));

  function update(): void {
    byId<HTMLOutputElement>("iso-value").value = numberInWords(settings.iso, 3);
    byId<HTMLOutputElement>("fog-value").value = `${fog.value} %`;
    byId("controls").classList.toggle("is-fog", settings.fog);
    iso.setAttribute("aria-valuetext", numberInWords(settings.iso, 3));
    fog.setAttribute("aria-valuetext", `${fog.value} %`);
    histogram.setIso(settings.iso);
    slices.draw();
    space?.set(settings);
  }
  iso.addEventListener("input", () => {
    settings.iso = volume.valueOf(Number(iso.value) / kIsoSteps);
    update();
  });
  fog.addEventListener("input", () => {
    settings.thickness = thicknessOf(Number(fog.value));
    update();
  });
  planes.addEventListener("change", () => {
    settings.planes = planes.checked;
    update();
  });
  for (const mode of modes) {
    mode.addEventListener("change", () => {
      settings.fog = mode.value === "fog" && mode.checked;
      update();
    });
  }
  byId("reset").addEventListener("click", () => {
    settings.iso = header.iso;
    settings.thickness = thicknessOf(50);
    settings.slices = middle(volume);
    fog.value = "50";
    isoToSlider();
    slices.reset();
    space?.resetCamera();
    update();
  });
  byId("controls").addEventListener("submit", (event) => event.preventDefault());

  const takeColors = () => {
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(name).trim();
    space?.setColors(color("--surface"), color("--inner"), color("--frame"));
    slices.draw();
  };
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", takeColors);
  if (space) space.onTurn = (toEye) => turnTriad(volume, toEye.elements);
  isoToSlider();
  takeColors();
  update();
}

readVolume()
  .then((volume) => {
    start(volume);
    document.documentElement.dataset.state = "ready";
  })
  .catch((error: unknown) => {
    const message = byId("message");
    message.textContent = error instanceof Error ? error.message : String(error);
    message.hidden = false;
    document.documentElement.dataset.state = "failed";
  });
