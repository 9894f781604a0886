// What the page adds to the picture: which worlds stand out, title, table, timeline, address. Run by ctest, as
// browser.test.mjs.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { browserOf, folder, near, open, pageOf, run } from './pages.mjs';

test('neighbours of the chosen world are dimmed, in both themes', async () => {
  const { file } = pageOf('ball2d', '--worlds', '4', '--seconds', '1');
  for (const [dark, sky] of [[false, [0xe9, 0xed, 0xf3]], [true, [0x12, 0x15, 0x1c]]]) {
    const view = await open(file, { dark });
    // Beside the mark that shows how it turns.
    const colorOf = async (cell) => {
      const { pixel } = await view.body(cell, 0);
      return view.pixel({ x: pixel.x - 4, y: pixel.y - 4 });
    };
    const { color } = await view.body(0, 0);
    assert.deepEqual([await colorOf(1), await colorOf(2)], [color, color]);
    await view.page.evaluate(() => window.manyworlds.choose(1, -1)); // the camera stays where it is
    await view.calm();
    assert.deepEqual(await colorOf(1), color);
    near(await colorOf(2), color.map((c, i) => 0.3 * c + 0.7 * sky[i]), 3, 'a neighbour');
    await view.key('Escape');
    assert.deepEqual(await colorOf(2), color);
    await view.close();
  }
});

test('title and legend have a background, on pages and in films', async () => {
  const { file } = pageOf('ball2d', '--worlds', '2', '--seconds', '1');
  for (const [theme, sky, panel, part] of [['light', [0xe9, 0xed, 0xf3], [255, 255, 255], 0.86], ['dark', [0x12, 0x15, 0x1c], [24, 28, 37], 0.84]]) {
    const page = await browserOf().newPage({ viewport: { width: 400, height: 260 } });
    await page.goto(`file://${file}#film&color=speed&theme=${theme}`);
    const { colors, legend, head } = await page.evaluate(async () => {
      await (await window.manyworldsReady).film();
      const image = new Image();
      image.src = `data:image/png;base64,${await window.manyworldsFilm.frame(0.5, 'image/png', true)}`;
      await image.decode();
      const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
      pen.drawImage(image, 0, 0);
      const boxes = ['head', 'moment'].map((id) => document.getElementById(id).getBoundingClientRect());
      // Left of the words.
      const found = boxes.map(({ left, top, height }) => [...pen.getImageData(left + 4, top + height / 2, 1, 1).data].slice(0, 3));
      return { colors: found, head: boxes[0].toJSON(), legend: document.getElementById('legend').getBoundingClientRect().toJSON() };
    });
    const wanted = panel.map((c, i) => part * c + (1 - part) * sky[i]);
    for (const color of colors) near(color, wanted, 2, theme);
    assert.ok(legend.left >= head.left && legend.right <= head.right && legend.bottom <= head.bottom, 'the legend is in the box');
    await page.close();

    const view = await open(file, { dark: theme === 'dark' });
    const background = await view.page.evaluate(() => getComputedStyle(document.getElementById('head')).backgroundColor);
    assert.equal(background, `rgba(${panel.join(', ')}, ${part})`);
    await view.close();
  }
});

test('a short recording plays again from its start, a long one once', async () => {
  const { file } = pageOf('ball2d', '--worlds', '1', '--seconds', '0.5');
  const view = await open(file);
  assert.equal((await view.report()).looping, true);
  assert.equal(await view.page.getAttribute('#loop', 'aria-pressed'), 'true');
  await view.seek(0.4);
  await view.page.keyboard.press(' ');
  await view.page.waitForFunction(() => window.manyworlds.report.time === 0.5); // the last frame stays for a moment
  await view.page.waitForFunction(() => window.manyworlds.report.time < 0.4);
  assert.equal((await view.report()).playing, true);
  await view.page.click('#loop');
  assert.equal(await view.page.getAttribute('#loop', 'aria-pressed'), 'false');
  await view.page.waitForFunction(() => !window.manyworlds.report.playing);
  assert.equal((await view.report()).time, 0.5);
  await view.page.keyboard.press('r');
  assert.equal((await view.report()).looping, true);
  await view.close();

  const long = await open(pageOf('ball2d', '--worlds', '1', '--seconds', '11').file);
  assert.equal((await long.report()).looping, false);
  await long.close();
});

test('a single moment has no timeline', async () => {
  const moment = join(folder, 'moment.h5');
  run('run', 'stack10', '--worlds', '2', '--steps', '1', '--record', moment, '--record-every', '10');
  const { file, head } = pageOf(moment, '--every', '2');
  assert.equal(head.runs[0].times.length, 1);
  const view = await open(file);
  assert.equal(await view.page.isVisible('#timeline'), false);
  await view.page.keyboard.press(' ');
  await view.calm();
  assert.equal((await view.report()).time, 0);
  await view.close();

  const longer = await open(pageOf('stack10', '--worlds', '2', '--seconds', '0.2').file);
  assert.equal(await longer.page.isVisible('#timeline'), true);
  await longer.close();
});

test('the line of a chosen body scrolls into view', async () => {
  const view = await open(pageOf('bin-boxes', '--worlds', '2', '--seconds', '0.2').file, { height: 420 });
  for (const row of [19, 0, 12]) {
    await view.page.evaluate((r) => window.manyworlds.choose(1, r), row);
    await view.calm();
    const { line, box, head } = await view.page.evaluate(() => {
      const of = (selector) => document.querySelector(selector).getBoundingClientRect().toJSON();
      return { line: of('#bodies tr.chosen'), box: of('#table-box'), head: of('thead th') };
    });
    assert.ok(line.top >= head.bottom - 1 && line.bottom <= box.bottom + 1, `row ${row}: ${line.top} to ${line.bottom} in ${head.bottom} to ${box.bottom}`);
  }
  // A click on a line leaves the others where they are.
  const scrolled = () => view.page.evaluate(() => document.getElementById('table-box').scrollTop);
  const before = await scrolled();
  await view.page.click('#bodies tr:nth-child(12)');
  await view.calm();
  assert.equal((await view.report()).chosen.row, 11);
  assert.equal(await scrolled(), before);
  await view.close();
});

test('the address chooses a body, and says what the page does not have', async () => {
  const { file, head } = pageOf('free-flight', '--worlds', '4', '--seconds', '2');
  const { bodies } = head.runs[0].kinds[0];
  const at = bodies.findIndex((body) => body.row === 3);
  const view = await open(file, { hash: `#world=2&follow=${bodies[at].name || at}&time=0.5&loop=off&theme=dark` });
  let report = await view.report();
  assert.deepEqual([report.chosen, report.following, report.time, report.looping], [{ cell: 2, row: 3 }, true, 0.5, false]);
  assert.equal(await view.page.isVisible('#message'), false);
  const begin = await view.body(2, 3);
  await view.seek(2);
  const end = await view.body(2, 3);
  assert.ok(Math.hypot(...end.position.map((x, c) => x - begin.position[c])) > 0.1, 'it moved');
  near([end.pixel.x, end.pixel.y], [begin.pixel.x, begin.pixel.y], 1.5, 'pixels');

  const complaint = async (hash) => {
    await view.page.evaluate((text) => { window.location.hash = text; }, hash);
    await view.page.waitForFunction((text) => window.location.hash === text, hash);
    await view.calm();
    return (await view.page.isVisible('#message')) ? view.page.locator('#message-text').textContent() : '';
  };
  assert.match(await complaint('#color=heat'), /\ncolor is 'heat'; expected body, speed, spin, rest, height or contact$/);
  assert.match(await complaint('#world=4'), /\nworld is '4'; expected 0 to 3$/);
  assert.match(await complaint('#world=1&follow=nobody'), /\nfollow is 'nobody'; expected a moving body: \S/);
  assert.match(await complaint('#theme=blue&time=soon'), /\ntime is 'soon'; expected seconds, 0 or later\ntheme is 'blue'; expected light or dark$/);
  assert.match(await complaint('#colour=speed'), /\n'colour' is unknown; expected time, theme, color, world, follow or loop$/);
  await view.page.click('#message-close');
  assert.equal(await view.page.isVisible('#message'), false);
  await complaint('#loop=maybe');
  assert.equal(await complaint('#color=speed&loop=on'), '');
  report = await view.report();
  assert.equal(report.looping, true);
  assert.equal(await view.page.inputValue('#color'), 'speed');
  await view.close();

  // Pages that are opened so, and films, which have no page to say it on.
  const wrong = await open(file, { hash: '#color=heat' });
  assert.match(await wrong.page.locator('#message').textContent(), /color is 'heat'; expected body/);
  await wrong.close();
  const film = await browserOf().newPage();
  await film.goto(`file://${file}#film&color=heat&world=9`);
  const thrown = await film.evaluate(() => window.manyworldsReady.catch((error) => error.message));
  assert.equal(thrown, "color is 'heat'; expected body, speed, spin, rest, height or contact; world is '9'; expected 0 to 3");
  await film.close();
});

test('balls turn only where their rotation is simulated, and the page says where it is not', async () => {
  const made = (...keep) => pageOf('ball2d', '--worlds', '1', '--seconds', '0.2', ...keep);
  for (const [page, turning] of [[made(), false], [made('--keep', 'orientation'), true]]) {
    assert.equal(page.head.runs[0].kinds[0].turns, turning);
    const view = await open(page.file);
    if (!turning) await view.page.waitForSelector('#unturned', { state: 'visible' });
    if (!turning) assert.match(await view.page.locator('#unturned').textContent(), /rotation .* is not simulated or drawn.*--keep orientation/);
    // The mark that shows how it turns, from the middle to the right.
    const { pixel, color } = await view.body(0, 0);
    const strip = [];
    for (const dy of [-2, -1, 0, 1, 2]) strip.push(await view.pixel({ x: pixel.x + 8, y: pixel.y + dy }));
    const marked = strip.some((seen) => String(seen) !== String(color));
    assert.equal(marked, turning, `${strip}`);
    assert.equal(await view.page.isVisible('#unturned'), !turning);  // now that frames are drawn
    await view.close();
  }
  const film = await browserOf().newPage();
  await film.goto(`file://${made().file}#film`);
  await film.evaluate(() => window.manyworldsReady);
  assert.equal(await film.isVisible('#unturned'), false);
  await film.close();
});
