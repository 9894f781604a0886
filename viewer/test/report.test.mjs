// The page of each report in a real browser. Run by ctest:
//   MANYWORLDS_CLI=program MANYWORLDS_REPORT=report.html CHROMIUM=browser PLAYWRIGHT=.../index.mjs
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launchBrowser, makeFolder, openPage, program } from './setup.mjs';

const { MANYWORLDS_REPORT: empty } = process.env;

const folder = makeFolder('report');
let browser;

function run(...args) {
  return execFileSync(program, args, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

// A short report, measured now.
function measured(kind, ...args) {
  const report = JSON.parse(run('report', kind, '--quick', ...args, '--json', '--out', folder));
  return { report, file: join(folder, `${kind}.html`) };
}

// The page of another report.
function pageOf(report, name) {
  const file = join(folder, `${name}.json`);
  writeFileSync(file, JSON.stringify(report));
  return run('report', 'page', file).trim();
}

// Opens a page without any network, and fails on what it complains of or asks for.
async function open(file, { width = 1400, dark = false } = {}) {
  const { context, page, complaints } = await openPage(browser, `file://${file}`, {
    viewport: { width, height: 800 }, offline: true, colorScheme: dark ? 'dark' : 'light',
  });
  return {
    page,
    totals: () => page.$$eval('.total', (all) => all.map((e) => e.innerText.replace(/\s+/g, ' '))),
    // What is told of the mark in the middle of those that `selector` finds in a figure.
    hover: async (figure, selector) => {
      const chart = page.locator(`figure[aria-label="${figure}"]`);
      await chart.scrollIntoViewIfNeeded();
      await chart.locator('svg.chart').first().waitFor();
      const marks = chart.locator(selector);
      const mark = marks.nth(Math.floor((await marks.count()) / 2));
      const told = page.getByRole('tooltip');
      // A figure that is drawn above while the pointer is on its way moves the mark away from it.
      for (let left = 10; ; --left) {
        const box = await mark.boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        const shown = await told.waitFor({ timeout: 3000 }).then(() => true, () => false);
        if (shown) break;
        assert.ok(left > 0, `nothing is told of a mark of ${figure}`);
      }
      const { x, width: wide } = await told.boundingBox();
      assert.ok(x >= 0 && x + wide <= width, `what is told is from ${x}, ${wide} wide`);
      return (await told.innerText()).replace(/\s+/g, ' ');
    },
    // How much wider than the window the page is, px.
    overhang: () => page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth),
    close: async () => {
      await context.close();
      assert.deepEqual(complaints, []);
    },
  };
}

// Every figure drawn, and nothing wider than a telephone.
async function fitsTelephone(file) {
  const view = await open(file, { width: 390, dark: true });
  const figures = view.page.locator('figure');
  for (let i = 0; i < await figures.count(); ++i) {
    if (!await figures.nth(i).isVisible()) continue;
    await figures.nth(i).scrollIntoViewIfNeeded();
    await figures.nth(i).locator('svg.chart').first().waitFor();
    const box = await figures.nth(i).boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 390, `figure ${i} is from ${box.x}, ${box.width} wide`);
  }
  assert.ok(await view.overhang() <= 0, `the page is ${await view.overhang()} px too wide`);
  await view.close();
}

before(async () => {
  assert.ok(existsSync(empty), `${empty} was not built`);
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test('accuracy: curves, the cheapest to an error, and cases that none reaches', async () => {
  const { report, file } = measured('accuracy', '--cases', 'A3,A4');
  const view = await open(file);
  const [passed, failed] = await view.totals();
  const reached = report.results.filter((c) => c.cheapest_at_level.length > 0).length;
  assert.equal(passed, `${reached} PASS: error reached`);
  assert.equal(failed, `${report.results.length - reached} FAIL: not reached`);
  const told = await view.hover('A4: error against run time', '[aria-label=dot] circle');
  assert.match(told, /method .+, f(32|64).*step [\d.]+ ms.*error [\d.e-]+ m.*run time [\d.]+ [mµ]?s/);
  // A method that is hidden has no line any more.
  const chart = view.page.locator('figure[aria-label="A4: error against run time"]');
  const lines = () => chart.locator('[aria-label=line] path').count();
  const all = await lines();
  await view.page.locator('.legend').nth(1).getByRole('button', { name: 'runge-kutta4', exact: true }).click();
  assert.equal(await lines(), all - 2); // in both precisions
  assert.deepEqual(await view.page.$$eval('#contents-list a', (all) => all.map((e) => e.getAttribute('href'))), ['#Summary', '#A3', '#A4']);
  await view.close();
  await fitsTelephone(file);

  report.results[0].cheapest_at_level = [];
  const other = await open(pageOf(report, 'unreached'));
  assert.equal((await other.totals())[1], `${report.results.length - reached + 1} FAIL: not reached`);
  await other.page.locator('#only-failures').click();
  const visible = await other.page.$$eval('main section', (all) => all.filter((e) => e.offsetParent !== null).map((e) => e.querySelector('h2').innerText));
  assert.ok(visible.some((text) => text.startsWith('A3 ')) && !visible.some((text) => text.endsWith('PASS')), visible.join());
  await other.close();
});

test('stability: totals, margins, and the failures alone', async () => {
  const { report, file } = measured('stability', '--cases', 'B9,B13,B15');
  report.results[0].note = 'a note </script><img src=x onerror=document.title=1>';
  const view = await open(pageOf(report, 'stability-noted'));
  const usual = report.results.filter((v) => v.setting === report.results[0].setting);
  const bad = report.results.filter((v) => !v.passed).length;
  const [passed, failed, , inAll] = await view.totals();
  assert.match(passed, new RegExp(`^${usual.filter((v) => v.passed).length} PASS`));
  assert.match(failed, new RegExp(`^${usual.filter((v) => !v.passed).length} FAIL`));
  assert.match(inAll, new RegExp(`^${bad} FAIL`));
  assert.ok(bad > 0 && bad < report.results.length);
  assert.equal(await view.page.locator('.matrix td.fail').count(), bad);
  assert.equal(await view.page.locator('.matrix td.pass').count(), report.results.length - bad);
  const told = await view.hover('Values relative to limits, contacts', '[aria-label=dot] circle, [aria-label=dot] path');
  assert.match(told, /case B\d+.*verdict (PASS|FAIL) [\d.e-]+.*limit [\d.e-]+/);
  const rows = view.page.locator('.matrix tbody tr:visible');
  const all = await rows.count();
  await view.page.locator('#only-failures').click();
  const cases = new Set(report.results.filter((v) => !v.passed).map((v) => v.id));
  assert.ok(all > cases.size);
  assert.equal(await rows.count(), cases.size);
  assert.match(await view.page.title(), /^manyworlds: /); // what a report says is text
  await view.close();
  await fitsTelephone(file);
});

test('invariants: shares by family, and the command for the worst world', async () => {
  const { report, file } = measured('invariants', '--kinds', '1', '--families', 'momentum');
  const view = await open(file);
  const required = report.results.filter((r) => r.required);
  const [passed, failed, worlds] = await view.totals();
  assert.equal(passed, `${required.filter((r) => r.passed).length} PASS`);
  assert.equal(failed, `${required.filter((r) => !r.passed).length} FAIL`);
  assert.equal(worlds, `${16 * report.results.length} worlds`);
  const told = await view.hover('Worlds that break the law, momentum', '[aria-label=dot] circle');
  assert.match(told, /family .+verdict (PASS|FAIL|not required).*broken \d+ of 16 worlds, [\d.]+ %.*worst .+, world \d+.*limit [\d.e-]+/);
  assert.equal(await view.page.getByText(report.results[0].command).count(), 1);
  await view.close();
  await fitsTelephone(file);

  const [first] = report.results;
  report.results = [{ ...first, broken: 16, share: 1, worst: null, passed: false, required: true },
    { ...first, units: 'earth', broken: 0, share: 0, worst: 0, passed: true, required: true }];
  const other = await open(pageOf(report, 'broken'));
  assert.equal((await other.totals())[1], '1 FAIL');
  assert.equal(await other.page.getByText('not finite').count(), 1);
  await other.page.locator('#only-failures').click();
  assert.equal(await other.page.locator('.filtered').last().locator('tbody tr:visible').count(), 1);
  await other.close();
});

test('plan: bits that must be equal, and ratios', async () => {
  const { report, file } = measured('plan', '--scenes', 'ball2d,chain2d');
  const view = await open(file);
  const judged = report.results.filter((r) => r.must_be_same);
  const [passed, failed] = await view.totals();
  assert.equal(passed, `${judged.length} PASS: equal bits`);
  assert.equal(failed, '0 FAIL: different bits');
  assert.match(await view.hover('ball2d', '[aria-label=dot] circle'), /variant .+time [\d.]+ times/);
  await view.close();
  await fitsTelephone(file);

  const wrong = report.results.find((r) => r.must_be_same);
  wrong.same_bits = false;
  for (const bodies of [16, 64]) {
    report.results.push({ ...wrong, scene: `bin-spheres:${bodies}`, variant: 'sparse against all pairs', bodies, same_bits: true });
  }
  const other = await open(pageOf(report, 'different'));
  assert.equal((await other.totals())[1], '1 FAIL: different bits');
  assert.equal(await other.page.locator('td.fail', { hasText: 'DIFFERENT' }).count(), 1);
  assert.match(await other.hover('Finding pairs', '[aria-label=dot] circle'), /bodies (16|64).*time [\d.]+ times/);
  await other.close();
});

test('throughput: sweeps, the same bits, and other engines', async () => {
  const { report, file } = measured('throughput', '--scenes', 'ball2d');
  const view = await open(file);
  assert.match((await view.totals())[0], /^[1-9]\d* PASS: same bits$/);
  assert.equal((await view.totals())[1], '0 FAIL: different bits');
  assert.match(await view.hover('Speed by worlds', '[aria-label=dot] circle'), /scene ball2d.*worlds \d+.*world-steps [\d.]+ [kMG]\/s/);
  await view.page.locator('#metric').selectOption('bytes per world');
  await view.page.locator('figure[aria-label="Speed by worlds"]').getByText('bytes per world').waitFor();
  await view.close();

  report.results.rows.filter((r) => r.sweep === 'threads').at(-1).hash = '0123456789abcdef';
  report.results.rows.push({ ...report.results.rows.find((r) => r.sweep === 'threads'), threads: 99, value: '99' });
  report.results.peer_protocol = { worlds: 128, steps: 60, rounds: 3, long_visit: 16 };
  report.results.peers = [{ scene: 'ball2d', world_steps_per_s: 1e6, long_visit: 2e6, worst_overlap_m: 0.004, worst_gap_m: null, engines: [
    { engine: 'Good', version: '1.2', rounds: 3, world_steps_per_s: 1e4, ratio: 100, long_visit: { world_steps_per_s: 4e4, ratio: 50 },
      worst_overlap_m: null, worst_gap_m: 0.01, settings: 'as it comes' },
    { engine: 'Slow', version: '3', rounds: 1, world_steps_per_s: 1e3, ratio: 1000, long_visit: null, worst_overlap_m: 0.02, worst_gap_m: null, settings: '' }] }];
  report.results.peer_means = { ratio: 100, long_visit: 50 };
  report.results.peer_failures = ['peer_bad failed: it fell over'];
  const changed = pageOf(report, 'peers');
  const other = await open(changed);
  assert.equal((await other.totals())[1], '1 FAIL: different bits');
  assert.equal((await other.totals())[2], '1 FAIL: other engines');
  assert.match(await other.hover('Speed compared with other engines', '[aria-label=dot] circle'), /engine .*speed [\d.]+ [kM]\/s.*worst (overlap 4 mm|gap 10 mm)/);
  assert.equal(await other.page.getByText('peer_bad failed: it fell over').count(), 1);
  assert.equal(await other.page.getByText('100 times as fast as the fastest engine of each scene (geometric mean), 50 times with 16 steps').count(), 1);
  await other.close();
  await fitsTelephone(changed);
});

test('a page says where there is no report, or one that it does not know, and has all licences', async () => {
  for (const [file, said] of [
    [empty, 'There is no report in this page'],
    [pageOf({ report: 'plan', results: 5 }, 'unknown'), 'This report cannot be shown completely'],
  ]) {
    const view = await open(file);
    await view.page.getByText(said).waitFor();
    await view.close();
  }
  const licences = /id="licences">([\s\S]*?)<\/script>/.exec(readFileSync(empty, 'utf8'))[1];
  for (const name of ['@observablehq/plot', 'd3-scale', 'd3-shape']) assert.ok(licences.includes(`${name} `), name);
});
