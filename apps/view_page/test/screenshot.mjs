// Makes a picture of a page:  node screenshot.mjs PAGE.html PICTURE.png [light|dark] [surface|fog]
// Pixels are half as large as the page's, so that one can reduce it without staircases.
import { resolve } from "node:path";
import { launch, open, settle } from "./browser.mjs";

const [file, picture, scheme = "light", mode = "surface"] = process.argv.slice(2);
const browser = await launch();
try {
  const { page } = await open(browser, resolve(file), { dark: scheme === "dark", scale: 2 });
  await page.evaluate((mode) => document.querySelector(`input[value=${mode}]`).click(), mode);
  await settle(page);
  await page.screenshot({ path: picture });
} finally {
  await browser.close();
}
