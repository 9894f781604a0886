// Where the camera stands for one world, and how it goes with what walks away in it.
//
// A world has the room that its recording needs, or that it had when a live page was opened. Where its bodies fill
// that, the camera shows the room and goes along only with what leaves it; where they are small in it, as a robot is
// that walks far, the camera shows them and stays with them. Nothing here depends on what was shown before.
import * as THREE from 'three';

import type { Box } from './stage';
import type { Worlds } from './worlds';

const SMALL = 0.4; // of the room, sides of what the camera stays with
const AROUND = 0.75; // of the largest side, of what is shown on each side of it
const RADII = 3; // of a followed body, likewise

export class Tether {
  private near = false;
  private readonly last = new THREE.Vector3();

  // The box to show of a world that was just chosen.
  begin(worlds: Worlds, cellIndex: number): Box {
    const { layout } = worlds;
    const cell = layout.cells[cellIndex];
    const box = worlds.boxOf(cellIndex);
    const size = box.getSize(new THREE.Vector3());
    const sides = worlds.planar ? [0, 1] : [0, 1, 2];
    const largest = Math.max(...sides.map((c) => size.getComponent(c)));
    const room = Math.max(...sides.map((c) => layout.high[c] - layout.low[c]));
    this.near = !box.isEmpty() && largest < SMALL * room;
    this.last.copy(this.offset(worlds, cellIndex));
    if (this.near) {
      box.expandByScalar(AROUND * largest);
      return { low: box.min.toArray(), high: box.max.toArray() };
    }
    const { x, y, z } = this.last;
    return {
      low: [cell.x + layout.low[0] + x, cell.y + layout.low[1] + y, layout.low[2] + z],
      high: [cell.x + layout.high[0] + x, cell.y + layout.high[1] + y, layout.high[2] + z],
    };
  }

  // The box to show of a body that is followed.
  around(worlds: Worlds, cellIndex: number, row: number): Box {
    this.hold(worlds, cellIndex);
    const { low, high } = worlds.layout;
    const sides = worlds.planar ? [0, 1] : [0, 1, 2];
    const room = Math.max(...sides.map((c) => high[c] - low[c]));
    const { radius } = worlds.kindOf(worlds.layout.cells[cellIndex]).bodies.find((body) => body.row === row)!;
    const half = Math.min(RADII * radius, room / 2);
    const place = worlds.placeOf(cellIndex, row, new THREE.Vector3()).toArray();
    return { low: place.map((x) => x - half), high: place.map((x) => x + half) };
  }

  // A world that was chosen without being shown: the camera stays, and goes along with what leaves the room.
  hold(worlds: Worlds, cellIndex: number): void {
    this.near = false;
    this.last.copy(this.offset(worlds, cellIndex));
  }

  // How far to move since the last call.
  pull(worlds: Worlds, cellIndex: number): THREE.Vector3 {
    const now = this.offset(worlds, cellIndex);
    const by = now.clone().sub(this.last);
    this.last.copy(now);
    return by;
  }

  private offset(worlds: Worlds, cellIndex: number): THREE.Vector3 {
    const cell = worlds.layout.cells[cellIndex];
    const middle = worlds.centerOf(cellIndex, new THREE.Vector3());
    if (this.near) return middle;
    const { low, high } = worlds.layout;
    const at = [middle.x - cell.x, middle.y - cell.y];
    // Up and down it stays, where worlds are piles and falls.
    const beyond = (c: number) => at[c] - Math.max(low[c], Math.min(high[c], at[c]));
    return new THREE.Vector3(beyond(0), worlds.planar ? 0 : beyond(1), 0);
  }
}
