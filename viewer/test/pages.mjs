// Pages of recordings in a browser, for tests: makes them, opens them offline, looks at them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { launchBrowser, makeFolder, openPage, program } from './setup.mjs';

export const { MANYWORLDS_VIEWER: viewer } = process.env;

export const folder = makeFolder('viewer');
let browser;
export const browserOf = () => browser;

export function run(...args) {
  return execFileSync(program, args, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

// A page of sources, made once, and what its head says.
const made = new Map();
export function pageOf(...args) {
  const key = args.join(' ');
  if (!made.has(key)) {
    const file = join(folder, `${made.size}.html`);
    run('view', ...args, '--out', file);
    const head = /id="mw-head">(.*?)<\/script>/s.exec(readFileSync(file, 'utf8'));
    made.set(key, { file, head: JSON.parse(head[1]) });
  }
  return made.get(key);
}

// Shapes of bodies that move, of all worlds.
export function shapesIn(head) {
  let out = 0;
  for (const r of head.runs) {
    for (const kind of r.kinds) {
      for (const body of kind.bodies) if (body.row !== null) out += kind.worlds * body.shapes.length;
    }
  }
  return out;
}

// Opens a page without any network, and fails on what it complains of or asks for.
export async function open(file, { width = 800, height = 560, dark = false, hash = '' } = {}) {
  const { context, page, complaints } = await openPage(browser, `file://${file}${hash}`, {
    viewport: { width, height }, offline: true, reducedMotion: 'reduce', colorScheme: dark ? 'dark' : 'light',
    allowed: (asked) => asked.split('#')[0] === `file://${file}` || asked.startsWith('blob:'),
  });
  await page.waitForFunction(() => window.manyworlds !== undefined, null, { timeout: 60000, polling: 50 });
  const calm = () => page.waitForFunction(() => {
    const { waiting, flying } = window.manyworlds.report;
    return !waiting && !flying;
  }, null, { timeout: 60000, polling: 50 });
  await calm();
  return {
    page, complaints, calm,
    report: () => page.evaluate(() => window.manyworlds.report),
    body: (cell, row) => page.evaluate(([c, r]) => window.manyworlds.bodyAt(c, r), [cell, row]),
    pixel: (at) => page.evaluate(({ x, y }) => window.manyworlds.pixelAt(x, y), at),
    seek: async (time) => {
      await page.evaluate((t) => window.manyworlds.seek(t), time);
      await calm();
    },
    key: async (key) => {
      await page.keyboard.press(key);
      await calm();
    },
    close: async () => {
      await context.close();
      // Software GL says how slow it is to read pixels; that is of the tests, not of the page.
      assert.deepEqual(complaints.filter((text) => !/GPU stall|swiftshader|software WebGL/i.test(text)), []);
    },
  };
}

// What the page's main thread does while `draw` draws so many frames, ms per frame, by the browser's profiler:
// `thread` is its processor's time in script, with what it hands to GL; the others are shares of samples of the clock,
// in functions of the page (`page`), in those that they call of the browser, GL above all (`calls`), and in collecting garbage.
export async function profiled(page, frames, draw) {
  const cdp = await page.context().newCDPSession(page);
  await cdp.send('Performance.enable', { timeDomain: 'threadTicks' });
  const scriptTime = async () => {
    const { metrics } = await cdp.send('Performance.getMetrics');
    return 1e3 * metrics.find(({ name }) => name === 'ScriptDuration').value;
  };
  await cdp.send('Profiler.enable');
  await cdp.send('Profiler.setSamplingInterval', { interval: 250 });
  const begin = await scriptTime();
  await cdp.send('Profiler.start');
  await draw();
  const { profile } = await cdp.send('Profiler.stop');
  const out = { thread: (await scriptTime()) - begin, page: 0, calls: 0, garbage: 0 };
  const kinds = new Map(profile.nodes.map(({ id, callFrame: { functionName: name, url } }) => [id,
    name === '(garbage collector)' ? 'garbage' : name.startsWith('(') && name !== '(anonymous)' ? 'idle' : url === '' ? 'calls' : 'page']));
  profile.samples.forEach((id, i) => {
    const kind = kinds.get(id);
    if (kind !== 'idle') out[kind] += Math.max(0, profile.timeDeltas[i]) / 1e3;
  });
  await cdp.detach();
  for (const name of Object.keys(out)) out[name] /= frames;
  return out;
}

export function near(found, wanted, within, what) {
  found.forEach((x, c) => assert.ok(Math.abs(x - wanted[c]) <= within, `${what}: ${found} is not ${wanted}`));
}

before(async () => {
  assert.ok(existsSync(viewer), `${viewer} was not built`);
  browser = await launchBrowser({ gl: true });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});
