// The page in a real browser, on recordings that the program makes for it. Run by ctest:
//   MANYWORLDS_CLI=program MANYWORLDS_VIEWER=viewer.html CHROMIUM=browser PLAYWRIGHT=.../index.mjs
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { browserOf, folder, near, open, pageOf, profiled, run, shapesIn, viewer } from './pages.mjs';

// Frames that are profiled: in software each takes a second or more.
const FRAMES = Number(process.env.MANYWORLDS_FRAMES ?? 4);

describe('scenes', () => {
  test('each opens offline, without a complaint, with as many shapes as were recorded', async () => {
    for (const { name } of JSON.parse(run('scenes', '--json'))) {
      const { file, head } = pageOf(name, '--worlds', '2', '--seconds', '0.4');
      const view = await open(file, { width: 400, height: 300 });
      const report = await view.report();
      assert.equal(report.worlds, 2, name);
      assert.equal(report.instances, shapesIn(head), name);
      assert.equal(report.drawn, shapesIn(head), name);
      assert.equal(report.frames[0], head.runs[0].times.length, name);
      const { still: { low, high }, cell } = report;
      if (low[0] !== null) {
        assert.ok(high[0] - low[0] < cell.width && high[1] - low[1] < cell.depth, `${name}: ${low} to ${high} is no tile of ${JSON.stringify(cell)}`);
      }
      await view.seek(0.4);
      await view.close();
    }
  });
});

describe('drawing', () => {
  test('a body is where it was recorded, in its colour', async () => {
    const { file, head } = pageOf('ball2d', '--worlds', '4', '--seconds', '3');
    const view = await open(file);
    const g = head.runs[0].kinds[0].gravity[1];
    const heights = [[], []];
    for (const time of [0, 0.2, 0.4]) { // it falls freely
      await view.seek(time);
      for (const [i, cell] of [0, 3].entries()) {
        const { position, pixel, color } = await view.body(cell, 0);
        heights[i].push(position[1]);
        // Beside the mark that shows how it turns.
        assert.deepEqual(await view.pixel({ x: pixel.x - 4, y: pixel.y - 4 }), color);
      }
    }
    for (const [a, b, c] of heights) assert.ok(Math.abs(c - 2 * b + a - g * 0.04) < 0.01, `${[a, b, c]}`);
    const before = await view.body(0, 0);
    await view.seek(0);
    const after = await view.body(0, 0);
    assert.ok(Math.hypot(before.pixel.x - after.pixel.x, before.pixel.y - after.pixel.y) > 20);
    assert.notDeepEqual(await view.pixel({ x: before.pixel.x - 4, y: before.pixel.y - 4 }), before.color);
    await view.close();
  });

  test('in space a body has its colour, shaded', async () => {
    const { file } = pageOf('ball3d', '--worlds', '1', '--seconds', '1');
    const view = await open(file);
    const { pixel, color } = await view.body(0, 0);
    const seen = await view.pixel(pixel);
    const order = (rgb) => [0, 1, 2].sort((a, b) => rgb[b] - rgb[a])[0];
    assert.equal(order(seen), order(color), `${seen} of ${color}`);
    assert.ok(Math.max(...seen) - Math.min(...seen) > 60, `${seen} has no colour`);
    await view.close();
  });

  test('a floor that is longer than its tile is cut at its sides, but for a world alone', async () => {
    for (const worlds of [1, 2]) {
      const { file, head } = pageOf('stack10', '--worlds', String(worlds), '--seconds', '0.2');
      const [kind] = head.runs[0].kinds;
      const box = kind.bodies.find((body) => body.row !== null);
      kind.bodies.push({ ...box, name: 'floor', motion: 'fixed', row: null, position: [0, 0, 0], rotation: [Math.SQRT1_2, 0, 0, Math.SQRT1_2],
        shapes: [{ ...box.shapes[0], shape: 99, size: [0.5, 100, 0.1] }] });
      const longer = join(folder, `floor-${worlds}.html`);
      writeFileSync(longer, readFileSync(file, 'utf8').replace(/(id="mw-head">).*?(?=<\/script>)/s, (_, tag) => tag + JSON.stringify(head)));
      const view = await open(longer);
      const { still: { low, high }, cell } = await view.report();
      if (worlds === 1) near([high[0], low[0]], [100, -100], 1e-3, 'the floor');
      else assert.ok(high[0] - low[0] > kind.high[0] - kind.low[0] && high[0] - low[0] < cell.width, `${low} to ${high} in ${cell.width}`);
      await view.close();
    }
  });

  test('motion goes on over chunks of frames, and between frames', async () => {
    const { file, head } = pageOf('free-flight', '--worlds', '1', '--seconds', '3');
    const view = await open(file);
    const { times } = head.runs[0];
    const places = [];
    for (const frame of [30, 31, 31.5, 32, 33, 34]) {
      const low = Math.floor(frame);
      await view.seek(times[low] + (frame - low) * (times[low + 1] - times[low]));
      places.push(await view.body(0, 0));
    }
    const step = places[1].position.map((x, c) => x - places[0].position[c]);
    assert.ok(Math.hypot(...step) > 1e-4);
    const radius = head.runs[0].kinds[0].bodies.find((body) => body.row === 0).radius;
    [1, 1.5, 2, 3, 4].forEach((n, i) => {
      near(places[i + 1].position, places[0].position.map((x, c) => x + n * step[c]), (n + 1) * radius / 250, `frame ${30 + n}`);
      assert.ok(Math.abs(Math.hypot(...places[i + 1].rotation) - 1) < 1e-5);
    });
    await view.close();
  });

  test('few calls draw many worlds, and the script is quick', async () => {
    const { file } = pageOf('bin-boxes', '--worlds', '1024', '--seconds', '1');
    const view = await open(file, { width: 640, height: 480, hash: '#time=0.5' });
    assert.equal(await view.page.isChecked('#shadows'), false); // there is no graphics card here
    const report = await view.report();
    assert.equal(report.instances, 20480);
    assert.equal(report.drawn, 20480);
    assert.ok(report.drawCalls <= 20, `${report.drawCalls} draw calls`);
    assert.equal(report.allCalls, report.drawCalls);
    const spent = (await view.page.evaluate(() => window.manyworlds.measure(90))).slice(30).sort((a, b) => a - b);
    console.log(`1024 worlds of bin-boxes, 20480 bodies: ${report.drawCalls} draw calls; script per frame, without GL, ` +
      `${spent[0].toFixed(1)} ms at least, ${spent[30].toFixed(1)} ms in the median of ${spent.length}`);
    const draw = (frames) => view.page.evaluate((n) => window.manyworlds.drawFrames(n), frames);
    await draw(1); // what is compiled and loaded once
    const found = await profiled(view.page, FRAMES, () => draw(FRAMES));
    console.log(`by the browser's profiler, per frame of ${FRAMES}, drawn: ${found.thread.toFixed(1)} ms of script on the thread's clock; ` +
      `of real time ${found.page.toFixed(1)} ms in the page's functions, ${found.calls.toFixed(1)} ms in GL and others that they call, ` +
      `${found.garbage.toFixed(1)} ms of garbage collection`);
    assert.ok(found.page > 0 && found.thread > 0, JSON.stringify(found)); // it saw the frames
    assert.deepEqual((({ instances, drawn, drawCalls }) => [instances, drawn, drawCalls])(await view.report()),
      [20480, 20480, report.drawCalls]);
    await view.close();
  });
});

describe('use', () => {
  test('keys play, step, scrub and change speed', async () => {
    const { file, head } = pageOf('stack10', '--worlds', '3', '--seconds', '2');
    const view = await open(file);
    const { times } = head.runs[0];
    assert.equal((await view.report()).time, 0);
    await view.key('ArrowRight');
    await view.key('ArrowRight');
    assert.equal((await view.report()).frame, 2);
    await view.key('ArrowLeft');
    assert.ok(Math.abs((await view.report()).time - times[1]) < 1e-9);
    await view.key('End');
    assert.equal((await view.report()).frame, times.length - 1);
    await view.key('Shift+ArrowLeft');
    assert.ok(Math.abs((await view.report()).time - (times.at(-1) - 1)) < 1e-6);
    await view.key('Home');
    await view.key(']');
    await view.key(']');
    assert.equal((await view.report()).speed, 4);
    await view.page.keyboard.press(' ');
    assert.equal((await view.report()).playing, true);
    await view.page.waitForFunction(() => window.manyworlds.report.time > 0.3);
    await view.page.keyboard.press(' ');
    assert.equal((await view.report()).playing, false);
    const slider = view.page.locator('#time');
    await slider.fill('1.25');
    await view.calm();
    assert.equal((await view.report()).time, 1.25);
    assert.match(await view.page.locator('#clock').textContent(), /^1\.25 \/ 2\.00 s$/);
    await view.close();
  });

  test('a click goes to a world and chooses a body, which can be followed', async () => {
    const { file } = pageOf('free-flight', '--worlds', '4', '--seconds', '2');
    const view = await open(file);
    const { pixel } = await view.body(2, 3);
    await view.page.mouse.click(pixel.x, pixel.y);
    await view.calm();
    let report = await view.report();
    assert.equal(report.chosen.cell, 2);
    // Another body may be before it; then it is that one which is under the cursor.
    const row = report.chosen.row;
    assert.ok(row >= 0);
    const there = await view.body(2, row);
    assert.equal(await view.page.locator('#bodies tr.chosen').count(), 1);
    assert.match(await view.page.locator('#world-name').textContent(), /^World 2/);
    await view.page.mouse.click(there.pixel.x, there.pixel.y);
    await view.calm();
    await view.key('f');
    assert.equal((await view.report()).following, true);
    const begin = await view.body(2, (await view.report()).chosen.row);
    await view.seek(1.5);
    report = await view.report();
    const end = await view.body(2, report.chosen.row);
    assert.ok(Math.hypot(...end.position.map((x, c) => x - begin.position[c])) > 0.1, 'it moved');
    near([end.pixel.x, end.pixel.y], [begin.pixel.x, begin.pixel.y], 1.5, 'pixels');
    await view.page.evaluate(() => { for (const id of ['trails', 'anchors', 'centers']) document.getElementById(id).click(); });
    await view.calm();
    await view.key('Escape');
    report = await view.report();
    assert.deepEqual(report.chosen, { cell: -1, row: -1 });
    assert.equal(report.following, false);
    await view.key('n');
    assert.equal((await view.report()).chosen.cell, 0);
    await view.close();
  });

  test('bounds are the boxes along the axes around bodies as they lie', async () => {
    const { file, head } = pageOf('free-flight', '--worlds', '1', '--seconds', '1');
    const view = await open(file, { hash: '#time=0.8&world=0' });
    for (const row of [0, 7]) {
      const { rotation: [x, y, z, w], bounds } = await view.body(0, row);
      const { size } = head.runs[0].kinds[0].bodies.find((body) => body.row === row).shapes[0];
      const turned = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]];
      near(bounds, turned.map((line) => 2 * line.reduce((sum, r, c) => sum + Math.abs(r) * size[c], 0)), 1e-5, 'bounds');
    }
    const before = (await view.report()).drawCalls;
    await view.key('b');
    assert.equal((await view.report()).drawCalls, before + 1);
    await view.close();
  });

  test('the camera stays with what drives away in the chosen world', async () => {
    const { file } = pageOf('car3d', '--worlds', '2', '--seconds', '4', '--random-controls');
    const view = await open(file, { hash: '#time=0&world=1' });
    const begin = await view.body(1, 0);
    await view.seek(4);
    const end = await view.body(1, 0);
    assert.ok(Math.hypot(...end.position.map((x, c) => x - begin.position[c])) > 1, `${end.position}`);
    near([end.pixel.x, end.pixel.y], [begin.pixel.x, begin.pixel.y], 12, 'pixels');
    await view.close();
  });

  test('a body hidden by nothing is the one that is picked', async () => {
    const { file } = pageOf('newton-cradle', '--worlds', '2', '--seconds', '1');
    const view = await open(file);
    for (const row of [0, 2, 4]) {
      const { pixel } = await view.body(1, row);
      await view.page.mouse.click(pixel.x, pixel.y);
      await view.calm();
      assert.deepEqual((await view.report()).chosen, { cell: 1, row });
    }
    await view.close();
  });

  test('colours follow numbers, and worlds that are lost are marked', async () => {
    const { file } = pageOf('ball2d', '--worlds', '4', '--seconds', '3');
    const view = await open(file);
    await view.page.selectOption('#color', 'speed');
    await view.seek(0.3);
    const fast = await view.body(0, 0);
    await view.seek(0);
    const slow = await view.body(0, 0);
    assert.notDeepEqual(fast.color, slow.color);
    assert.deepEqual(await view.pixel({ x: slow.pixel.x - 4, y: slow.pixel.y - 4 }), slow.color);
    assert.match(await view.page.locator('#legend-name').textContent(), /^speed, m\/s$/);
    assert.equal(await view.page.locator('#ticks span').count(), 5);
    assert.doesNotMatch(await view.page.locator('#about').textContent(), /lost/);
    await view.close();

    const far = pageOf('ball2d', '--worlds', '2', '--seconds', '1', '--set', 'bounds=-50,3,-1,50,50,1');
    const lost = await open(far.file);
    await lost.seek(1);
    assert.match(await lost.page.locator('#about').textContent(), /2 lost/);
    const { pixel } = await lost.body(0, 0);
    const seen = await lost.pixel({ x: pixel.x - 4, y: pixel.y - 4 });
    assert.ok(seen[0] > seen[1] + 60 && seen[0] > seen[2] + 60, `${seen} is not red`);
    await lost.key('l');
    assert.match(await lost.page.locator('#world-about').textContent(), /out of bounds/);
    await lost.close();
  });

  test('two recordings side by side, or overlaid', async () => {
    const files = ['f32', 'f64'].map((precision) => {
      const file = join(folder, `${precision}.h5`);
      run('run', 'stack10', '--worlds', '3', '--steps', '60', '--precision', precision, '--record', file, '--record-every', '2');
      return file;
    });
    const { file, head } = pageOf(...files);
    assert.equal(head.runs.length, 2);
    const view = await open(file);
    let report = await view.report();
    assert.equal(report.worlds, 6);
    assert.equal(report.instances, shapesIn(head));
    const beside = [await view.body(0, 9), await view.body(3, 9)];
    assert.ok(Math.abs(beside[0].pixel.x - beside[1].pixel.x) > 50);
    await view.page.selectOption('#compare', 'ghosts');
    await view.calm();
    report = await view.report();
    assert.equal(report.worlds, 6);
    const one = [await view.body(0, 9), await view.body(3, 9)];
    near([one[0].pixel.x, one[0].pixel.y], [one[1].pixel.x, one[1].pixel.y], 3, 'pixels');
    await view.page.selectOption('#color', 'run');
    await view.calm();
    await view.close();
  });

  test('everything has its place on a phone and on a desk, dark and light', async () => {
    const { file } = pageOf('stack10', '--worlds', '3', '--seconds', '2');
    for (const [width, height] of [[390, 844], [1400, 900]]) {
      for (const dark of [false, true]) {
        const view = await open(file, { width, height, dark });
        if (width < 500) await view.page.click('#panel-button');
        await view.key('n');
        const boxes = await view.page.evaluate(() => ['head', 'buttons', 'panel', 'timeline'].map((id) => {
          const { left, right, top, bottom } = document.getElementById(id).getBoundingClientRect();
          return { id, left, right, top, bottom };
        }));
        boxes.forEach((a, i) => {
          assert.ok(a.left >= 0 && a.right <= width && a.top >= 0 && a.bottom <= height, `${a.id} is cut at ${width}`);
          for (const b of boxes.slice(i + 1)) {
            const apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
            assert.ok(apart, `${a.id} and ${b.id} overlap at ${width}`);
          }
        });
        assert.equal(await view.page.evaluate(() => document.documentElement.classList.contains('dark')), dark);
        assert.ok(await view.page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
        await view.close();
      }
    }
  });

  test('a page without a recording says so', async () => {
    const context = await browserOf().newContext({ offline: true });
    const page = await context.newPage();
    await page.goto(`file://${viewer}`);
    await page.waitForFunction(() => !document.getElementById('message').hidden);
    assert.match(await page.locator('#message').textContent(), /This page has no recording\. Create a page with manyworlds view/);
    await context.close();
  });
});
