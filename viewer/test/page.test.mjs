// What the page adds to the picture: which worlds stand out, title, table, timeline, address. Run by ctest, as
// browser.test.mjs.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { near, open, pageOf } from './pages.mjs';

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
