// Numbers that a page draws: contacts with their forces, and what colours mean. Run by ctest, as browser.test.mjs.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { browserOf, near, open, pageOf } from './pages.mjs';

test('contacts bear the weight, and are drawn and coloured by', async () => {
  const { file, head } = pageOf('stack10', '--worlds', '2', '--seconds', '3', '--fps', '10');
  const [kind] = head.runs[0].kinds;
  const weight = 10 * kind.bodies[1].mass * -kind.gravity[2];
  const view = await open(file, { width: 700, height: 420, hash: '#time=3' });
  const contacts = await view.page.evaluate(() => window.manyworlds.contactsAt(1));
  const onGround = contacts.filter(({ a }) => kind.bodies[a].row === null);
  assert.equal(contacts.length, 40);
  assert.equal(onGround.length, 4);
  for (const { normal } of contacts) near(normal, [0, 0, 1], 0.05, 'normal');
  for (const { point } of onGround) assert.ok(Math.abs(point[2]) < 0.02, `${point}`);
  const borne = onGround.reduce((sum, { force }) => sum + force, 0);
  assert.ok(Math.abs(borne / weight - 1) < 0.05, `${borne} N of ${weight} N`);
  const before = await view.report();
  assert.equal(before.contacts, 0);
  await view.key('x');
  let report = await view.report();
  assert.equal(report.contacts, 80);
  assert.equal(report.drawCalls, before.drawCalls + 2);
  await view.key('n');
  report = await view.report();
  assert.equal(report.contacts, 40); // of the chosen world alone
  await view.page.selectOption('#color', 'contact');
  await view.calm();
  const [low, high] = [await view.body(1, 0), await view.body(1, 9)];
  assert.ok(low.force > 10 * high.force, `${low.force} N, ${high.force} N`);
  assert.notDeepEqual(low.color, high.color);
  await view.close();

  const without = await open(pageOf('ball2d', '--worlds', '1', '--seconds', '0.2', '--contacts', '0').file);
  assert.equal(await without.page.isVisible('#contacts'), false);
  assert.equal(await without.page.locator('#color option[value=contact]').count(), 0);
  await without.close();
});

test('the legend has the numbers and the unit of the colours', async () => {
  const { file, head } = pageOf('ball2d', '--worlds', '2', '--seconds', '1');
  const view = await open(file, { hash: '#time=0.5' });
  const numbers = async () => (await view.page.locator('#ticks span').allTextContents()).map((text) => Number(text.replace('−', '-')));
  assert.equal(await view.page.isVisible('#legend'), false); // bodies by their own colours
  await view.page.selectOption('#color', 'height');
  await view.calm();
  assert.equal(await view.page.isVisible('#legend'), true);
  assert.equal(await view.page.locator('#legend-name').textContent(), 'height, m');
  const { low, high } = head.runs[0].kinds[0];
  near(await numbers(), [0, 1, 2, 3, 4].map((i) => low[1] + (i / 4) * (high[1] - low[1])), 0.01 * (high[1] - low[1]), 'height');
  await view.page.selectOption('#color', 'speed');
  await view.calm();
  const [still, , , , fastest] = await numbers();
  const g = -head.runs[0].kinds[0].gravity[1];
  assert.equal(still, 0);
  assert.ok(fastest > 0.4 * g && fastest < 0.7 * g, `${fastest} m/s after 0.5 s of falling`);
  await view.page.selectOption('#color', 'rest');
  await view.calm();
  assert.deepEqual(await view.page.locator('#ticks span').allTextContents(), ['at rest', 'moving']);
  await view.page.selectOption('#color', 'body');
  await view.calm();
  assert.equal(await view.page.isVisible('#legend'), false);
  await view.close();
});

test('pictures and films have the legend', async () => {
  const { file } = pageOf('ball2d', '--worlds', '2', '--seconds', '1');
  const view = await browserOf().newPage({ viewport: { width: 400, height: 260 } });
  await view.goto(`file://${file}#film&color=speed`);
  await view.evaluate(() => window.manyworldsReady.then((app) => app.film()));
  const found = await view.evaluate(async () => {
    const image = new Image();
    image.src = `data:image/png;base64,${await window.manyworldsFilm.frame(0.5, 'image/png', true)}`;
    await image.decode();
    const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
    pen.drawImage(image, 0, 0);
    const bar = document.getElementById('scale').getBoundingClientRect();
    const words = document.getElementById('ticks').getBoundingClientRect();
    const at = (x) => [...pen.getImageData(x, (bar.top + bar.bottom) / 2, 1, 1).data].slice(0, 3);
    const below = pen.getImageData(words.left, words.top, words.width, words.height).data;
    const shades = new Set();
    for (let i = 0; i < below.length; i += 4) shades.add(below[i]);
    return { ends: [at(bar.left + 1), at(bar.right - 2)], shades: shades.size };
  });
  near(found.ends[0], [0x44, 0x01, 0x54], 4, 'the lowest'); // viridis
  near(found.ends[1], [0xfd, 0xe7, 0x25], 4, 'the highest');
  assert.ok(found.shades > 5, 'no numbers are below the bar');
  await view.close();
});
