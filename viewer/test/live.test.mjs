// The live page in a real browser, against the program that serves it. Run by ctest, as browser.test.mjs.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readdirSync, rmSync } from 'node:fs';
import { request } from 'node:http';
import { after, before, describe, test } from 'node:test';
import { launchBrowser, makeFolder, openPage, program } from './setup.mjs';

const folder = makeFolder('live');
let browser;
const children = [];

// The program, and the address that it prints.
async function serve(...args) {
  const child = spawn(program, ['view', ...args, '--live', '--json'], { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'] });
  children.push(child);
  let out = '';
  let err = '';
  child.stderr.on('data', (data) => { err += data; });
  const head = await new Promise((resolve, reject) => {
    child.stdout.on('data', (data) => {
      out += data;
      if (out.trimEnd().endsWith('}')) resolve(JSON.parse(out));
    });
    child.on('exit', (code) => reject(new Error(`it ended with ${code}: ${err}`)));
  });
  const ended = new Promise((resolve) => { child.on('exit', (code) => resolve(code)); });
  return {
    ...head,
    running: () => child.exitCode === null,
    stop: async () => {
      child.kill('SIGINT');
      assert.equal(await ended, 0, err);
    },
  };
}

async function open(url) {
  const { context, page, complaints } = await openPage(browser, url, {
    viewport: { width: 640, height: 400 }, reducedMotion: 'reduce',
    allowed: (asked) => asked.startsWith(url) || asked.startsWith('blob:'),
  });
  await page.waitForFunction(() => window.manyworlds !== undefined, null, { timeout: 60000, polling: 50 });
  const until = (f, argument) => page.waitForFunction(f, argument, { timeout: 60000, polling: 20 });
  return {
    page, until,
    report: () => page.evaluate(() => window.manyworlds.report),
    body: (cell, row) => page.evaluate(([c, r]) => window.manyworlds.bodyAt(c, r), [cell, row]),
    // Frames that came from now on.
    frames: async (count) => {
      const now = await page.evaluate(() => window.manyworlds.report.live.frames);
      await until(([n]) => window.manyworlds.report.live.frames >= n, [now + count]);
    },
    close: async () => {
      await context.close();
      assert.deepEqual(complaints.filter((text) => !/GPU stall|swiftshader|software WebGL/i.test(text)), []);
    },
  };
}

// The status of a request, with what a browser would not send.
function status(url, headers = {}, path = new URL(url).pathname) {
  return new Promise((resolve, reject) => {
    const asked = request({ host: '127.0.0.1', port: new URL(url).port, path, headers }, (answer) => {
      answer.resume();
      resolve(answer.statusCode);
    });
    asked.on('upgrade', (answer, socket) => {
      socket.destroy();
      resolve(answer.statusCode);
    });
    asked.on('error', reject);
    asked.end();
  });
}

// A socket by hand, whose messages of up to 125 bytes are masked with zeros.
function rawSocket(url) {
  const { port, host, pathname } = new URL(url);
  return new Promise((resolve, reject) => {
    const asked = request({ host: '127.0.0.1', port, path: `${pathname}socket`, headers: { ...upgrade, Origin: `http://${host}` } });
    asked.on('upgrade', (answer, socket) => resolve({
      socket,
      send: (text) => socket.write(Buffer.concat([Buffer.from([0x81, 0x80 | text.length, 0, 0, 0, 0]), Buffer.from(text)])),
    }));
    asked.on('error', reject);
    asked.end();
  });
}

const upgrade = {
  Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': '13', 'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==',
};

before(async () => {
  browser = await launchBrowser({ gl: true });
});

after(async () => {
  await browser?.close();
  for (const child of children) child.kill('SIGKILL'); // those of tests that failed
  rmSync(folder, { recursive: true, force: true });
});

describe('who is served', () => {
  test('the token, Host and Origin decide', async () => {
    const live = await serve('ball3d', '--worlds', '1', '--paused');
    const { url, port } = live;
    const socket = new URL('socket', url).pathname;
    const origin = `http://127.0.0.1:${port}`;
    const wrong = `/${'0'.repeat(32)}/`;
    assert.equal(await status(url), 200);
    assert.equal(await status(url, { Host: `localhost:${port}` }), 200);
    assert.equal(await status(url, {}, wrong), 403);
    assert.equal(await status(url, {}, '/'), 403);
    assert.equal(await status(url, { Host: `evil.example:${port}` }), 403);
    assert.equal(await status(url, { Host: '127.0.0.1' }), 403);
    assert.equal(await status(url, { Origin: 'http://evil.example' }), 403);
    assert.equal(await status(url, { ...upgrade, Origin: origin }, socket), 101);
    assert.equal(await status(url, { ...upgrade, Origin: origin }, `${wrong}socket`), 403);
    assert.equal(await status(url, { ...upgrade, Origin: 'null' }, socket), 403);
    assert.equal(await status(url, { ...upgrade, Origin: `http://evil.example:${port}` }, socket), 403);
    assert.equal(await status(url, upgrade, socket), 403);
    assert.equal(await status(url, { ...upgrade, Origin: origin, Host: `evil.example:${port}` }, socket), 403);
    await live.stop();
  });
});

describe('the clock', () => {
  test('play, pause, step, reset and speed are those of the program', async () => {
    const live = await serve('ball2d', '--worlds', '4', '--paused');
    const view = await open(live.url);
    const first = await view.report();
    assert.equal(first.worlds, 4);
    assert.deepEqual([first.live.paused, first.live.steps], [true, 0]);
    await view.page.click('#on');
    await view.until(() => window.manyworlds.report.live.steps === 1);
    await view.page.keyboard.press('ArrowRight');
    await view.until(() => window.manyworlds.report.live.steps === 2);
    await view.page.click('#play');
    await view.until(() => !window.manyworlds.report.live.paused && window.manyworlds.report.live.steps > 10);
    await view.page.selectOption('#speed', 'Infinity');
    await view.until(() => window.manyworlds.report.live.reached > 5);
    await view.page.keyboard.press('Space');
    await view.until(() => window.manyworlds.report.live.paused);
    const { steps } = (await view.report()).live;
    await view.page.click('#on');
    await view.until((n) => window.manyworlds.report.live.steps === n, steps + 1);
    await view.page.click('#live-reset');
    await view.until(() => window.manyworlds.report.live.steps === 0);
    await view.close();
    await live.stop();
  });
});

describe('bodies', () => {
  test('a drag moves one towards the cursor, a push throws it, a slider turns gravity off', async () => {
    const live = await serve('ball3d', '--worlds', '1');
    const view = await open(live.url);
    assert.deepEqual(live.sliders, ['gravity', 'friction']);
    await view.page.locator('input[aria-label=gravity]').evaluate((input) => {
      input.value = '0';
      input.dispatchEvent(new Event('input'));
    });
    await view.page.click('#live-reset');
    await view.frames(3);
    const { mouse } = view.page;
    const apart = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);
    let { pixel } = await view.body(0, 0);
    const goal = { x: pixel.x + 90, y: pixel.y - 40 };
    await mouse.move(pixel.x, pixel.y);
    await mouse.down();
    await mouse.move(goal.x, goal.y, { steps: 4 });
    await view.until(() => window.manyworlds.report.live.dragging);
    await view.until(([x, y]) => {
      const at = window.manyworlds.bodyAt(0, 0).pixel;
      return Math.hypot(at.x - x, at.y - y) < 30; // its middle is farther away than the plane of the drag
    }, [goal.x, goal.y]);
    await mouse.up();
    await view.frames(5);
    ({ pixel } = await view.body(0, 0));
    assert.ok(apart(pixel, goal) < 40, 'it stays where it was put, without gravity');

    const start = (await view.body(0, 0)).position;
    await view.page.keyboard.down('Shift');
    await mouse.click(pixel.x, pixel.y);
    await view.page.keyboard.up('Shift');
    await view.until(([x, y, z]) => {
      const at = window.manyworlds.bodyAt(0, 0).position;
      return Math.hypot(at[0] - x, at[1] - y, at[2] - z) > 0.2;
    }, start);
    await view.close();
    await live.stop();
  });

  test('the sliders of controls drive a robot', async () => {
    const live = await serve('ant', '--worlds', '1');
    const view = await open(live.url);
    const sliders = view.page.locator('#live-controls input');
    assert.equal(await sliders.count(), 8);
    const before = (await view.body(0, 2)).rotation;
    await sliders.first().evaluate((input) => {
      input.value = input.max;
      input.dispatchEvent(new Event('input'));
    });
    await view.until((was) => window.manyworlds.bodyAt(0, 2).rotation.some((x, c) => Math.abs(x - was[c]) > 0.05), before);
    await view.close();
    await live.stop();
  });
});

describe('what a page may not do', () => {
  test('messages that are none close the page that sent them, and no other', async () => {
    const live = await serve('ball3d', '--worlds', '2');
    const view = await open(live.url);
    const answers = await view.page.evaluate(async () => {
      const hostile = [
        'no JSON', '[]', '{}', '{"do":"explode"}', '{"do":"frame"}', '{"do":"open","worlds":3}', '{"do":"open","worlds":1.5}',
        '{"do":"drag","world":0,"body":99,"at":[0,0,0],"to":[0,0,0]}', '{"do":"drag","world":-1,"body":1,"at":[0,0,0],"to":[0,0,0]}',
        '{"do":"push","world":0,"body":1,"at":[0,0,0],"impulse":[1e300,0,0]}', '{"do":"speed","factor":-1}', '{"do":"speed","factor":"1"}',
        '{"do":"pause","why":1}', `{"do":"reset","world":${'['.repeat(5000)}`, '{"do":"save","file":"/etc/passwd"}', new Uint8Array([1, 2, 3]),
        'x'.repeat(70000), '{"do":"controls","values":[1]}', '{"do":"gravity","value":[0,0,null]}', '{"do":"step","steps":1e9}',
      ];
      const out = [];
      for (const message of hostile) {
        out.push(await new Promise((resolve) => {
          const socket = new WebSocket(`ws://${location.host}${location.pathname}socket`);
          socket.onopen = () => socket.send(message);
          socket.onmessage = () => resolve('answered');
          socket.onclose = (event) => resolve(`${event.code} ${event.reason}`);
        }));
      }
      return out;
    });
    for (const answer of answers) assert.match(answer, /^(1008 .+|1009 .*)$/, JSON.stringify(answers));
    await view.frames(5); // it goes on
    await view.close();
    await live.stop();
  });

  test('pages that are closed in the middle, or read nothing, hold nobody up', async () => {
    const live = await serve('bin2d', '--worlds', '4', '--speed', 'max');
    const gone = await open(live.url);
    await gone.page.mouse.move(200, 200);
    await gone.page.mouse.down();
    const deaf = await rawSocket(live.url);
    deaf.send('{"do":"open","worlds":4}');
    deaf.send('{"do":"frame"}');
    deaf.socket.pause(); // it asks and never reads
    const view = await open(live.url);
    await view.frames(3);
    await gone.page.context().close();
    await view.frames(5);
    deaf.socket.resetAndDestroy();
    await view.frames(5);
    assert.ok(live.running());
    await view.page.click('#live-save');
    await view.until(() => document.getElementById('live-said').textContent.startsWith('saved '));
    assert.equal(readdirSync(folder).filter((name) => /^bin2d-step\d+\.snapshot$/.test(name)).length, 1);
    await live.stop();
    await view.until(() => !document.getElementById('message').hidden);
    await view.close();
  });
});
