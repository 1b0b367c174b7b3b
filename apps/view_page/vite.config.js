import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

const here = dirname(fileURLToPath(import.meta.url));

// The page says what it was made of, so that a test without npm finds out if that has changed since:
// cat index.html package-lock.json tsconfig.json vite.config.js src/* | sha256sum
function digestOfSources() {
  const names = ["index.html", "package-lock.json", "tsconfig.json", "vite.config.js"];
  for (const name of readdirSync(join(here, "src")).sort()) names.push(join("src", name));
  const hash = createHash("sha256");
  for (const name of names) hash.update(readFileSync(join(here, name)));
  return hash.digest("hex");
}

// Puts script and style into the page itself: it has to work as a single file, without a server.
function inlineAll() {
  return {
    name: "inline-all",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["index.html"];
      let scripts = "";
      let styles = "";
      for (const [name, part] of Object.entries(bundle)) {
        if (part === page) continue;
        if (name.endsWith(".css")) styles += part.source;
        else if (part.type === "chunk") scripts += part.code;
        else this.error(`${name} cannot be put into the page`);
        delete bundle[name];
      }
      // Neither may end its element early.
      scripts = scripts.replaceAll("</script", "<\\/script").replaceAll("<!--", "\\x3C!--").trim();
      page.source = String(page.source)
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        // The script comes after the data, so that those are there.
        .replace("</head>", () => `<meta name="bandvox-sources" content="${digestOfSources()}">\n` + `<style>${styles.trim()}</style>\n</head>`)
        .replace("</body>", () => `<script>\n${scripts}\n</script>\n</body>`);
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [inlineAll()],
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { output: { format: "iife", inlineDynamicImports: true } },
  },
});
