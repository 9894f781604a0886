// Boxes along the axes of the world around bodies, as they are drawn.
import * as THREE from 'three';

import type { Cell } from './layout';
import type { Drawable } from './drawables';
import type { Worlds } from './worlds';

// Widens `box` by a shape whose body is at p, turned by q.
function addShape(d: Drawable, world: number, p: THREE.Vector3, q: THREE.Quaternion, box: THREE.Box3): void {
  const at = 6 * world;
  const [sx, sy, sz] = d.sizes === null ? d.size : d.sizes.subarray(at, at + 3);
  const [tx, ty, tz] = d.sizes === null ? d.stretch : d.sizes.subarray(at + 3, at + 6);
  const place = new THREE.Matrix4().compose(p, q, new THREE.Vector3(1, 1, 1)).multiply(new THREE.Matrix4().compose(
    new THREE.Vector3().fromArray(d.position), new THREE.Quaternion().fromArray(d.rotation), new THREE.Vector3(1, 1, 1)));
  const level = d.mesh.levels[0];
  const points = level.points.length > 0 ? level.points : level.lines; // outlines in the plane
  const v = new THREE.Vector3();
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = [points[i], points[i + 1], points[i + 2]];
    v.set(sx * x + tx * Math.sign(x), sy * y + ty * Math.sign(y), sz * z + tz * Math.sign(z));
    box.expandByPoint(v.applyMatrix4(place));
  }
}

// The box of each moving body of a world that is there, by row.
export function boundsOf(worlds: Worlds, cellIndex: number): Map<number, THREE.Box3> {
  const out = new Map<number, THREE.Box3>();
  const cell: Cell = worlds.layout.cells[cellIndex];
  const { rows } = worlds.kindOf(cell);
  const poses = worlds.posesOf(cell);
  const p = new THREE.Vector3();
  const q = new THREE.Quaternion();
  for (const d of worlds.viewOf(cell).drawables) {
    const item = cell.world * rows + d.row;
    if (d.row < 0 || poses.there[item] === 0) continue;
    const box = out.get(d.row) ?? new THREE.Box3();
    addShape(d, cell.world, worlds.placeOf(cellIndex, d.row, p), q.fromArray(poses.rotation, 4 * item), box);
    out.set(d.row, box);
  }
  return out;
}
