// Pictures and films that the program makes in a real browser; run by ctest as browser.test.mjs is.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, readFileSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { launchBrowser, makeFolder, program } from './setup.mjs';

const folder = makeFolder('film');
const encoder = join(dirname(fileURLToPath(import.meta.url)), '..', '..', 'tests', 'support', 'fake_encoder.sh');
const scene = ['ball2d', '--worlds', '4', '--seconds', '0.6'];
const size = { width: 320, height: 200 };
// 6 frames from 0.1 to 0.6 s, each of which the recording has.
const film = ['--fps', '5', '--speed', '0.5', '--begin', '0.1', '--size', '320x200'];
const times = Array.from({ length: 6 }, (_, k) => 0.1 + 0.1 * k);
let browser;

function run(args, environment = {}) {
  return execFileSync(program, ['view', ...scene, ...args],
    { env: { ...process.env, ...environment }, cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

// Each frame, as an address with its data, is the page at its time, and not half a frame later: by the mean difference
// of bytes that differ between the two.
async function checkFrames(frames, within) {
  assert.equal(frames.length, times.length);
  const page = await browser.newPage({ viewport: size });
  await page.goto(`file://${join(folder, 'page.html')}#film`);
  await page.evaluate(() => window.manyworldsReady.then((app) => app.film()));
  for (const [k, url] of frames.entries()) {
    const found = await page.evaluate(async ([own, time]) => {
      const pixels = async (data) => {
        const image = new Image();
        image.src = data;
        await image.decode();
        const pen = new OffscreenCanvas(image.width, image.height).getContext('2d');
        pen.drawImage(image, 0, 0);
        return pen.getImageData(0, 0, image.width, image.height).data;
      };
      const at = async (t) => pixels(`data:image/png;base64,${await window.manyworldsFilm.frame(t, 'image/png', true)}`);
      const [seen, now, later] = [await pixels(own), await at(time), await at(time > 0.59 ? time - 0.05 : time + 0.05)];
      const out = { bytes: 0, now: 0, later: 0 };
      for (let i = 0; i < now.length; ++i) {
        if (Math.abs(now[i] - later[i]) < 40) continue;
        ++out.bytes;
        out.now += Math.abs(seen[i] - now[i]);
        out.later += Math.abs(seen[i] - later[i]);
      }
      return { ...out, now: out.now / out.bytes, later: out.later / out.bytes };
    }, [url, times[k]]);
    assert.ok(found.bytes > 50 && found.now < within && found.later > 40, `frame ${k}: ${JSON.stringify(found)}`);
  }
  await page.close();
}

before(async () => {
  browser = await launchBrowser({ gl: true });
  run(['--fps', '10', '--out', 'page.html']);
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test('the program takes pictures', async () => {
  const file = join(folder, 'picture.png');
  run(['--png', file, '--time', '0.2', '--size', '320x200']);
  const bytes = readFileSync(file);
  assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
  assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [320, 200]);
  // Not empty: a browser shows it, and the ball's colour is in it.
  const context = await browser.newContext();
  const page = await context.newPage();
  const found = await page.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(data)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height);
    const pen = canvas.getContext('2d');
    pen.drawImage(image, 0, 0);
    const { data: rgba } = pen.getImageData(0, 0, image.width, image.height);
    const colors = new Set();
    for (let i = 0; i < rgba.length; i += 4) colors.add(rgba.slice(i, i + 3).join());
    return [...colors];
  }, `data:image/png;base64,${bytes.toString('base64')}`);
  await context.close();
  assert.ok(found.includes('243,167,18'), 'no ball');
  assert.throws(() => run(['--png', file], { CHROMIUM: '/no/such/browser' }), /needs a browser, found none of \/no\/such\/browser/);
});

test('each frame of a film is the page at exactly its time', async () => {
  run([...film, '--mp4', 'a film.mp4'], { FFMPEG: encoder, MODE: '' }); // keeps pictures as they come
  const bytes = readFileSync(join(folder, 'a film.mp4'));
  const frames = [];
  for (let at = 0; at >= 0;) {
    const next = bytes.indexOf(Buffer.from([0xff, 0xd8, 0xff]), at + 3);
    frames.push(`data:image/jpeg;base64,${bytes.subarray(at, next < 0 ? bytes.length : next).toString('base64')}`);
    at = next;
  }
  await checkFrames(frames, 12);
});

test('a browser plays what ffmpeg makes of it', async (t) => {
  if (spawnSync('ffmpeg', ['-version']).error) return t.skip('ffmpeg is not installed');
  const report = JSON.parse(run([...film, '--mp4', 'film.mp4', '--json']));
  assert.equal(report.film.frames, 6);
  const page = await browser.newPage();
  const video = await page.evaluate(async (url) => {
    const one = document.createElement('video');
    await new Promise((resolve, reject) => {
      one.onloadeddata = resolve;
      one.onerror = () => reject(new Error(one.error.message));
      one.src = url;
    });
    return [one.videoWidth, one.videoHeight, one.duration];
  }, `data:video/mp4;base64,${readFileSync(join(folder, 'film.mp4')).toString('base64')}`);
  await page.close();
  assert.deepEqual(video.map((x) => Math.round(1e3 * x) / 1e3), [320, 200, 1.2]);
  execFileSync('ffmpeg', ['-loglevel', 'error', '-i', 'film.mp4', 'frame%d.png'], { cwd: folder, stdio: 'inherit' });
  const frames = times.map((_, k) => `data:image/png;base64,${readFileSync(join(folder, `frame${k + 1}.png`)).toString('base64')}`);
  assert.ok(!existsSync(join(folder, `frame${times.length + 1}.png`)));
  await checkFrames(frames, 25);
  return undefined;
});

test('a film follows a body of a world', async () => {
  run(['--fps', '10', '--out', 'page.html']);
  const page = await browser.newPage({ viewport: size });
  await page.goto(`file://${join(folder, 'page.html')}#film&world=2&follow=1`);
  const found = await page.evaluate(async () => {
    const app = await window.manyworldsReady;
    await app.film();
    const out = [];
    for (const time of [0, 0.3, 0.6]) {
      await window.manyworldsFilm.frame(time, 'image/jpeg', true);
      const { position, pixel } = window.manyworlds.bodyAt(2, 0);
      out.push({ height: position[1], x: pixel.x, y: pixel.y });
    }
    return out;
  });
  await page.close();
  assert.ok(found[0].height - found[2].height > 1, 'it falls');
  for (const { x, y } of found) assert.ok(Math.hypot(x - found[0].x, y - found[0].y) < 1, JSON.stringify(found));
  // In the middle of what the title leaves free.
  assert.ok(Math.abs(found[0].x - size.width / 2) < 3 && Math.abs(found[0].y - size.height / 2) < size.height / 4, JSON.stringify(found));
});
