// Opens pages that the command makes in Chromium, does what a visitor does, and looks whether the
// picture changes as it should. BANDVOX names the command, BANDVOX_SHOTS a folder for pictures.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, settle } from "./browser.mjs";

const bandvox = process.env.BANDVOX ?? "bandvox";
const shots = process.env.BANDVOX_SHOTS;
const folder = mkdtempSync(join(tmpdir(), "bandvox-view-"));
let browser;

function make(name, shape, convert = [], view = []) {
  const vdb = join(folder, `${name}.vdb`);
  const html = join(folder, `${name}.html`);
  execFileSync(bandvox, ["convert", "-q", shape, "-o", vdb, "-r", "48", ...convert]);
  execFileSync(bandvox, ["view", "-q", vdb, "-o", html, ...view]);
  return html;
}

/** Sets a slider as a visitor does. */
async function slide(page, id, value) {
  await page.evaluate(
    (id, value) => {
      const slider = document.getElementById(id);
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    },
    id,
    value,
  );
  await settle(page);
}

const cut = async (page, selector) => {
  const element = await page.$(selector);
  return element.screenshot({ encoding: "base64" });
};
/** What tells pictures from each other, short enough for a message. */
const digest = async (picture) => createHash("sha256").update(await picture).digest("hex");
const inSpace = (page) => digest(cut(page, "#view"));
const slice = (page, axis) => digest(cut(page, `#slices figure:nth-child(${axis + 1}) canvas`));

/** How many of the picture's pixels are seen to hold something, from 0 to 1. */
async function covered(page) {
  const picture = await cut(page, "#view");
  return page.evaluate(async (source) => {
    const image = new Image();
    image.src = `data:image/png;base64,${source}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    // The ground is grey; the surface is warm.
    let warm = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] - data[i + 2] > 12) ++warm;
    return warm / (data.length / 4);
  }, picture);
}

async function shoot(page, name) {
  if (shots) await page.screenshot({ path: join(shots, `${name}.png`) });
}

before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test("shows a surface, and does what its controls say", async () => {
  const html = make("torus", "shape:torus");
  const { page, troubles } = await open(browser, html);
  await settle(page);
  assert.equal(await page.title(), "torus.vdb");
  assert.equal(await page.evaluate(() => document.getElementById("view-message").hidden), true);
  await shoot(page, "surface");

  // A torus of radii 1 and 0.4 or so fills a part of the picture, neither all nor nothing.
  await page.evaluate(() => document.getElementById("planes").click());
  await settle(page);
  const solid = await covered(page);
  assert.ok(solid > 0.05 && solid < 0.6, `${solid} of the picture`);

  // A higher iso-value makes it thinner, and moves the contours of the slices.
  const sliceBefore = await slice(page, 2);
  await slide(page, "iso", 950);
  const thin = await covered(page);
  assert.ok(thin < 0.97 * solid, `${thin} instead of ${solid}`);
  assert.notEqual(await slice(page, 2), sliceBefore);
  assert.match(await page.$eval("#histogram .iso-text", (mark) => mark.textContent), /^0\.9/);

  // Beyond all values there is nothing but the axes in the corner.
  await slide(page, "iso", 1000);
  assert.ok((await covered(page)) < 1e-3);
  await page.click("#reset");
  await settle(page);
  assert.ok(Math.abs((await covered(page)) - solid) < 1e-3);

  // Slices change one by one.
  const all = await Promise.all([0, 1, 2].map((axis) => slice(page, axis)));
  await slide(page, "slice-y", 3);
  assert.equal(await slice(page, 0), all[0]);
  assert.notEqual(await slice(page, 1), all[1]);
  assert.equal(await slice(page, 2), all[2]);

  // Fog looks different, and the thicker, the more so.
  const surface = await inSpace(page);
  await page.evaluate(() => document.querySelector("input[value=fog]").click());
  await settle(page);
  const fog = await inSpace(page);
  assert.notEqual(fog, surface);
  await slide(page, "fog", 20);
  assert.notEqual(await inSpace(page), fog);
  await shoot(page, "fog");
  assert.deepEqual(troubles, []);
  await page.close();
});

test("turns by mouse and by keys", async () => {
  const html = make("cube", "shape:cube");
  const { page, troubles } = await open(browser, html);
  await settle(page);
  await page.focus("#view-canvas");
  // The first key also shows where the focus is.
  await page.keyboard.press("0");
  await settle(page);
  const start = await inSpace(page);
  await page.keyboard.press("ArrowRight");
  await settle(page);
  const turned = await inSpace(page);
  assert.notEqual(turned, start);
  await page.keyboard.press("+");
  await settle(page);
  assert.notEqual(await inSpace(page), turned);
  await page.keyboard.press("0");
  await settle(page);
  assert.equal(await inSpace(page), start);
  await page.mouse.move(300, 300);
  await page.mouse.down();
  await page.mouse.move(380, 320, { steps: 4 });
  await page.mouse.up();
  await settle(page);
  assert.notEqual(await inSpace(page), start);
  // Everything that can be set can be reached by the tabulator.
  const reached = new Set();
  for (let i = 0; i < 12; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement?.id || document.activeElement?.name));
  }
  for (const id of ["iso", "planes", "reset", "slice-x", "slice-y", "slice-z"]) assert.ok(reached.has(id), id);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("tells the error budget", async () => {
  const html = make("sphere", "shape:sphere", ["--half"]);
  const { page, troubles } = await open(browser, html);
  const words = await page.$eval("#budget", (panel) => panel.textContent);
  for (const word of ["within the tolerance", "Closure", "Storage", "Volume of the source", "exact", "cutoff 0.16"]) {
    assert.ok(words.includes(word), `${word} in ${words}`);
  }
  assert.ok((await page.$$("#spectrum path.measured")).length === 1);
  assert.ok((await page.$eval("#about", (panel) => panel.textContent)).includes("stored with 16 bits"));
  assert.deepEqual(troubles, []);
  await page.close();
});

test("leaves sampling apart from the tolerance", async () => {
  const html = make("sampled", "shape:sphere", ["--route", "sampled", "--oversample", "4"]);
  const { page, troubles } = await open(browser, html);
  const words = await page.$eval("#budget .verdict", (verdict) => verdict.textContent);
  assert.match(words, /^Sampling changed the density by 0\.0/);
  assert.equal((await page.$$("#budget .meter-bad")).length, 0);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("takes text for text", async () => {
  const evil = "</script><img src=x onerror=\"window.hurt = 1\"><b>bold</b> & more";
  const html = make("evil", "shape:sphere", [], ["--title", evil]);
  const { page, troubles } = await open(browser, html);
  assert.equal(await page.title(), evil);
  assert.equal(await page.$eval("#title", (title) => title.textContent), evil);
  assert.equal(await page.evaluate(() => window.hurt), undefined);
  assert.equal((await page.$$("h1 b, h1 img")).length, 0);
  assert.deepEqual(troubles, []);
  await page.close();
});

test("fits a telephone, in the dark, too", async () => {
  const html = make("tree", "shape:tree");
  for (const dark of [false, true]) {
    const { page, troubles } = await open(browser, html, { width: 390, height: 844, dark });
    await settle(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await shoot(page, dark ? "telephone_dark" : "telephone");
    assert.deepEqual(troubles, []);
    await page.close();
  }
});

test("without WebGL still shows slices, histogram and spectrum", async () => {
  const html = make("plain", "shape:torus");
  const plain = await launch({ webgl: false });
  try {
    const { page } = await open(plain, html);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.state), "ready");
    const words = await page.$eval("#view-message", (message) => (message.hidden ? "" : message.textContent));
    assert.match(words, /WebGL 2/);
    const before = await slice(page, 0);
    await page.evaluate(() => {
      const slider = document.getElementById("slice-x");
      slider.value = "10";
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    });
    assert.notEqual(await slice(page, 0), before);
    assert.equal((await page.$$("#spectrum path.measured")).length, 1);
    assert.equal((await page.$$("#histogram path.bar-active")).length, 1);
    await shoot(page, "without_webgl");
  } finally {
    await plain.close();
  }
});
