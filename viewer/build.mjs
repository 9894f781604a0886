// Bundles the page into one file without data: node build.mjs OUT.html
import { readFile, writeFile, mkdir, rename } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, 'dist', 'viewer.html');
const bundled = await build({
  entryPoints: [join(here, 'src', 'main.ts')],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2022',
  legalComments: 'inline', // three.js wants its notice kept
  charset: 'utf8',
});
const script = bundled.outputFiles[0].text.replaceAll('</script', '<\\/script');
const style = await readFile(join(here, 'src', 'page.css'), 'utf8');
const page = (await readFile(join(here, 'src', 'page.html'), 'utf8'))
  .replace('/* style */', () => style)
  .replace('/* script */', () => script);
await mkdir(dirname(out), { recursive: true });
await writeFile(`${out}.part`, page);
await rename(`${out}.part`, out);
