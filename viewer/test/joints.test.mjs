// Joints, each drawn as what it is. Run by ctest, as browser.test.mjs.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { deflateSync, inflateSync } from 'node:zlib';
import { folder, near, open, pageOf } from './pages.mjs';

const METAL = [0x4d, 0x57, 0x68];
const ROPE = [0x7a, 0x5c, 0x34];

// A page whose scene has these joints, too.
function withJoints(scene, name, joints) {
  const { file, head } = pageOf(scene, '--worlds', '2', '--seconds', '0.2');
  const other = structuredClone(head);
  other.runs[0].kinds[0].joints = joints;
  const out = join(folder, `${name}.html`);
  writeFileSync(out, readFileSync(file, 'utf8').replace(/(id="mw-head">).*?(?=<\/script>)/s, (_, tag) => tag + JSON.stringify(other)));
  return out;
}

const end = (body, position) => ({ body, position, rotation: [1, 0, 0, 0] });

// Around what is drawn at a place of a world: how near a colour comes.
async function nearest(view, cell, place, color) {
  const { x, y } = await view.page.evaluate(([c, p]) => window.manyworlds.pixelOf(c, p), [cell, place]);
  let best = Infinity;
  for (const [dx, dy] of [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]]) {
    const seen = await view.pixel({ x: x + dx, y: y + dy });
    best = Math.min(best, Math.hypot(...seen.map((c, i) => c - color[i])));
  }
  return best;
}

test('rods, pulleys and hinges of scenes are drawn in all worlds, until they are switched off', async () => {
  for (const [scene, type, color] of [['cradle-joints', 'distance', METAL], ['pulley', 'pulley', ROPE], ['chain2d', 'hinge', METAL], ['humanoid', 'hinge', null]]) {
    const { file, head } = pageOf(scene, '--worlds', '2', '--seconds', '0.2');
    const { joints, low, high } = head.runs[0].kinds[0];
    assert.ok(joints.length > 0 && joints.some((joint) => joint.type === type), scene);
    const view = await open(file);
    const { joints: drawn, drawCalls, allCalls } = await view.report();
    assert.equal(drawn, 2 * joints.length, scene);
    if (scene !== 'humanoid') assert.equal(allCalls, drawCalls, scene); // no shadows there
    if (color !== null) {
      const { position, grounds } = await view.page.evaluate(() => ({ position: window.manyworlds.bodyAt(1, 0).position,
        grounds: window.manyworlds.jointsOf(1)[0].grounds }));
      const [one] = joints;
      const places = { distance: () => one.a.position.map((x, c) => (x + position[c]) / 2), pulley: () => grounds[0].map((x, c) => (x + grounds[1][c]) / 2),
        hinge: () => one.a.position.map((x, c) => x + (c === 0 ? 0.09 * head.runs[0].kinds[0].bodies[one.body_b].radius : 0)) };
      const place = places[type]();
      place.forEach((x, c) => assert.ok(x >= low[c] && x <= high[c], `${scene}: ${place} is not in the room`));
      assert.ok(await nearest(view, 1, place, color) < 40, `${scene}: nothing is drawn at ${place}`);
      await view.key('j');
      assert.equal((await view.report()).joints, 0);
      assert.ok(await nearest(view, 1, place, color) > 40, `${scene}: something is drawn at ${place}`);
    }
    await view.close();
  }
});

test('a rope is straight when it is taut, and hangs when it is slack', async () => {
  const { head } = pageOf('ball2d', '--worlds', '2', '--seconds', '0.2');
  const kind = head.runs[0].kinds[0];
  const ball = kind.bodies.findIndex((body) => body.row === 0);
  const view0 = await open(pageOf('ball2d', '--worlds', '2', '--seconds', '0.2').file);
  const { position } = await view0.body(1, 0);
  await view0.close();
  const anchor = [position[0] - 2 * kind.bodies[ball].radius, position[1], 0];
  const middle = anchor.map((x, c) => (x + position[c]) / 2);
  const far = Math.hypot(...anchor.map((x, c) => x - position[c]));
  for (const [length, sag] of [[far, 0], [1.5 * far, 0.5]]) {
    const rope = { name: '', type: 'distance', body_a: null, body_b: ball, a: end(null, anchor), b: end(ball, [0, 0, 0]), form: 'rope', length };
    const view = await open(withJoints('ball2d', `rope-${sag}`, [rope]));
    assert.equal((await view.report()).joints, 2);
    const straight = await nearest(view, 1, middle, ROPE);
    if (sag === 0) assert.ok(straight < 40, `${straight}`);
    else assert.ok(straight > 40, `${straight}`);
    // A parabola 1.5 times as long as its chord hangs by 0.51 of that.
    const below = await nearest(view, 1, [middle[0], middle[1] - 0.51 * far, 0], ROPE);
    if (sag > 0) assert.ok(below < 40, `${below}`);
    await view.close();
  }
});

test('every type of joint has a look, in the plane and in space', async () => {
  for (const scene of ['ball2d', 'ball3d']) {
    const { head } = pageOf(scene, '--worlds', '2', '--seconds', '0.2');
    const { bodies, low, high } = head.runs[0].kinds[0];
    const ball = bodies.findIndex((body) => body.row === 0);
    const inside = low.map((x, c) => x + 0.3 * (high[c] - x));
    const both = { name: '', body_a: null, body_b: ball, a: end(null, inside), b: end(ball, [0, 0, 0]) };
    const joints = [
      ...['rod', 'rope', 'spring', 'telescope'].map((form) => ({ ...both, type: 'distance', form, length: 9 })),
      { ...both, type: 'pulley', grounds: [[-1, 3, 2], [1, 3, 2]] }, { ...both, type: 'slider', range: [-1, 1] }, { ...both, type: 'slider', range: null },
      ...['ball', 'hinge', 'fixed', 'wheel', 'target'].map((type) => ({ ...both, type, range: null })),
      // Within a series: one end alone, or none.
      { ...both, type: 'hinge', b: null }, { ...both, type: 'hinge', a: null }, { ...both, type: 'hinge', a: null, b: null },
    ];
    const view = await open(withJoints(scene, `all-${scene}`, joints), { width: 400, height: 300 });
    const { joints: drawn, jointPieces } = await view.report();
    assert.equal(drawn, 2 * joints.length);
    const pins = scene === 'ball2d' ? { bar: 22, ring: 6 } : { bar: 26, ring: 2 };
    const wanted = { ball: 4, spring: 3, block: 3, ...pins }; // of one world; 14 bars are the rope
    assert.deepEqual(jointPieces, Object.fromEntries(Object.keys(jointPieces).map((name) => [name, 2 * wanted[name]])), scene);
    assert.equal(Object.keys(jointPieces).length, 5);
    await view.close();
  }
});

test('a joint is drawn until it breaks', async () => {
  const { file, head } = pageOf('ball2d', '--worlds', '2', '--seconds', '0.2', '--contacts', '0');
  const other = structuredClone(head);
  const [run] = other.runs;
  const [kind] = run.kinds;
  const ball = kind.bodies.findIndex((body) => body.row === 0);
  kind.joints = [{ name: '', type: 'distance', body_a: null, body_b: ball, a: end(null, [0, 1, 0]), b: end(ball, [0, 0, 0]), form: 'rod', length: 1 }];
  run.joints_enabled = true;
  // A channel more, behind that of the status: 1 always, and 1 until frame 3, as what a straight line does not foretell.
  const { frames, widths } = run.chunks[0];
  assert.equal(widths.length, 6);
  const flags = [[2], [2, 0, 0, 1, 2]].flatMap((codes) => Array.from({ length: frames }, (_, f) => codes[f] ?? 0));
  widths.push(1);
  const page = readFileSync(file, 'utf8')
    .replace(/(id="mw-head">).*?(?=<\/script>)/s, (_, tag) => tag + JSON.stringify(other))
    .replace(/(id="mw-0-0">)(.*?)(?=<\/script>)/s, (_, tag, text) =>
      tag + deflateSync(Buffer.concat([inflateSync(Buffer.from(text, 'base64')), Buffer.from(flags)])).toString('base64'));
  const out = join(folder, 'breaks.html');
  writeFileSync(out, page);
  const view = await open(out);
  for (const [frame, joints] of [[0, 2], [2, 2], [3, 1], [frames - 1, 1], [1, 2]]) {
    await view.seek(head.runs[0].times[frame]);
    assert.equal((await view.report()).joints, joints, `frame ${frame}`);
  }
  await view.close();
});
