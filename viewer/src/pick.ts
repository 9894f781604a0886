// What lies under a ray.
import * as THREE from 'three';

import type { Worlds } from './worlds';

export interface Hit {
  cell: number;
  row: number;
  point: THREE.Vector3; // m, as drawn
}

// The body under a ray: exact, triangle by triangle, of shapes whose spheres it meets.
export function pickBody(worlds: Worlds, ray: THREE.Ray): Hit | null {
  let best = Infinity;
  let found: Hit | null = null;
  const q = new THREE.Quaternion();
  const center = new THREE.Vector3();
  const local = new THREE.Ray();
  const hit = new THREE.Vector3();
  const abc = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
  const cells = worlds.layout.cells;
  for (let n = 0; n < cells.length; ++n) {
    const cell = cells[n];
    const view = worlds.viewOf(cell);
    const kind = worlds.kindOf(cell);
    for (const d of view.drawables) {
      if (d.row < 0) continue;
      const item = cell.world * kind.rows + d.row;
      if (view.poses.there[item] === 0) continue;
      const p = view.poses.position;
      center.set(p[3 * item] + cell.x, p[3 * item + 1] + cell.y, worlds.planar ? 0 : p[3 * item + 2]);
      if (ray.distanceSqToPoint(center) > (1.01 * d.body.radius) ** 2) continue;
      q.fromArray(view.poses.rotation, 4 * item);
      const shapeAt = new THREE.Vector3(...d.position).applyQuaternion(q).add(center);
      q.multiply(new THREE.Quaternion(...d.rotation)).invert();
      local.origin.copy(ray.origin).sub(shapeAt).applyQuaternion(q);
      local.direction.copy(ray.direction).applyQuaternion(q);
      const mesh = worlds.runOf(cell).meshes[d.body.shapes.find((s) => s.shape === d.shape)!.mesh];
      const level = mesh.levels[mesh.levels.length - 1];
      const size = d.sizes === null ? d.size : d.sizes.subarray(6 * cell.world, 6 * cell.world + 3);
      const stretch = d.sizes === null ? d.stretch : d.sizes.subarray(6 * cell.world + 3, 6 * cell.world + 6);
      for (let t = 0; t < level.triangles.length; t += 3) {
        for (let k = 0; k < 3; ++k) {
          const at = 3 * level.triangles[t + k];
          for (let c = 0; c < 3; ++c) {
            const x = level.points[at + c];
            abc[k].setComponent(c, x * size[c] + stretch[c] * Math.sign(x));
          }
        }
        if (local.intersectTriangle(abc[0], abc[1], abc[2], false, hit) === null) continue;
        const away = hit.distanceTo(local.origin);
        const far = away - (worlds.planar ? 0.01 * d.row : 0);
        if (far < best) {
          best = far;
          found = { cell: n, row: d.row, point: ray.at(away, new THREE.Vector3()) };
        }
      }
    }
  }
  return found;
}

// The world whose cell a ray meets first, on the ground or, in the plane, at z = 0.
export function pickCell(worlds: Worlds, ray: THREE.Ray): number {
  const { low, high, cells } = worlds.layout;
  const box = new THREE.Box3();
  const hit = new THREE.Vector3();
  let best = Infinity;
  let found = -1;
  cells.forEach((cell, n) => {
    box.min.set(cell.x + low[0], cell.y + low[1], worlds.planar ? -1 : low[2]);
    box.max.set(cell.x + high[0], cell.y + high[1], worlds.planar ? 1 : low[2] + 0.5 * (high[2] - low[2]));
    if (ray.intersectBox(box, hit) === null) return;
    const far = hit.distanceTo(ray.origin);
    if (far < best) {
      best = far;
      found = n;
    }
  });
  return found;
}
