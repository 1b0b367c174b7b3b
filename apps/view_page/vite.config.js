import { defineConfig } from "vite";

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
        .replace("</head>", () => `<style>${styles.trim()}</style>\n</head>`)
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
