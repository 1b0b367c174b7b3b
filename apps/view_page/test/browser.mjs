// A browser without a window, that draws WebGL by the processor.
import { access } from "node:fs/promises";
import puppeteer from "puppeteer-core";

const kPlaces = [process.env.BANDVOX_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

async function findBrowser() {
  for (const place of kPlaces) {
    if (!place) continue;
    try {
      await access(place);
      return place;
    } catch {
      // Not there.
    }
  }
  throw new Error(`no browser at ${kPlaces.filter(Boolean).join(", ")}; scripts/setup --view installs one`);
}

export async function launch({ webgl = true } = {}) {
  return puppeteer.launch({
    executablePath: await findBrowser(),
    headless: true,
    args: [
      "--no-sandbox",
      "--hide-scrollbars",
      "--force-color-profile=srgb",
      ...(webgl
        ? ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
        : ["--disable-gpu", "--disable-3d-apis"]),
    ],
    protocolTimeout: 240_000,
  });
}

/** Opens a page from its file; `troubles` collects what its console complains of, and what it asks
 *  the network for. */
export async function open(browser, file, { width = 1280, height = 800, dark = false, scale = 1 } = {}) {
  const page = await browser.newPage();
  const troubles = [];
  page.on("console", (message) => {
    // What SwiftShader is slow at is none of the page's faults.
    if (/GPU stall|software WebGL|GL Driver Message/i.test(message.text())) return;
    if (["error", "warn"].includes(message.type())) troubles.push(message.text());
  });
  page.on("pageerror", (error) => troubles.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) troubles.push(`asked for ${request.url()}`);
  });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await page.setViewport({ width, height, deviceScaleFactor: scale });
  await page.goto(`file://${file}`, { waitUntil: "load" });
  await page.waitForFunction(() => document.documentElement.dataset.state, { timeout: 60_000 });
  return { page, troubles };
}

/** Waits until the picture in space is drawn in full. */
export async function settle(page) {
  let before = "";
  for (let i = 0; i < 60; ++i) {
    await new Promise((done) => setTimeout(done, 250));
    const now = await page.evaluate(() => {
      const { drawn, coarse } = document.getElementById("view-canvas").dataset;
      return `${drawn} ${coarse}`;
    });
    if (now === before && !now.endsWith("true")) return;
    before = now;
  }
}
