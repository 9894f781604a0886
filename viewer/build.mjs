// Bundles the pages, each into one file without data: node build.mjs FOLDER makes viewer.html and
// report.html there, and LICENSES.txt of the packages that they contain.
import { readFile, writeFile, mkdir, readdir, rename } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, 'dist');

// The licences of the packages that a bundle has, since most want them kept with every copy.
async function licences(inputs) {
  const packages = new Set();
  for (const input of inputs) {
    const found = /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(input);
    if (found) packages.add(found[1]);
  }
  const texts = new Map();
  for (const path of [...packages].sort()) {
    const { name, version } = JSON.parse(await readFile(join(here, path, 'package.json'), 'utf8'));
    const file = (await readdir(join(here, path))).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} comes without its licence`);
    texts.set(`${name} ${version}`, (await readFile(join(here, path, file), 'utf8')).trim());
  }
  return texts;
}

const inOneText = (texts) => [...texts].map(([name, text]) => `${name}\n\n${text}\n`).join('\n');

async function page(name, source) {
  const read = (file) => readFile(join(here, 'src', file), 'utf8');
  const bundled = await build({
    entryPoints: [join(here, 'src', `${source}main.ts`)],
    absWorkingDir: here,
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none', // whole licences follow
    charset: 'utf8',
  });
  const script = bundled.outputFiles[0].text.replaceAll('</script', '<\\/script');
  const texts = await licences(Object.keys(bundled.metafile.inputs));
  const escaped = inOneText(texts).replaceAll('</script', '<\\/script');
  const legal = `<script type="text/plain" id="licences">\n${escaped}</script>\n`;
  const [theme, style] = [await read('theme.css'), await read(`${source}page.css`)];
  const text = (await read(`${source}page.html`))
    .replace('/* theme */', () => theme)
    .replace('/* style */', () => style)
    .replace('/* script */', () => script)
    .replace('</body>', () => `${legal}</body>`);
  await write(name, text);
  return texts;
}

async function write(name, text) {
  await mkdir(folder, { recursive: true });
  const out = join(folder, name);
  await writeFile(`${out}.part`, text);
  await rename(`${out}.part`, out);
}

const viewer = await page('viewer.html', '');
const report = await page('report.html', 'report/');
await write('LICENSES.txt', inOneText(new Map([...new Map([...viewer, ...report])].sort())));
