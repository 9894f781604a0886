// Contacts of worlds: points, and arrows along the normal that are as long as the force on body B is large.
import * as THREE from 'three';

import { Batch, STRIDE } from './batches';
import { linear, type Rgb } from './colors';
import { weightOf } from './contacts';
import type { Kind } from './data';
import type { Worlds } from './worlds';

const MOST = 8192; // points that are drawn
const PER_WEIGHT = 2; // radii of the mean body that an arrow of a mean body's weight is long
const LIFT = 40; // above what is drawn in the plane

// Along z from 0 to 1, the head from 0.72 on, across as wide as its size says.
function arrow(): { points: Float32Array; triangles: Uint32Array } {
  const shaft = new THREE.CylinderGeometry(1, 1, 0.72, 8).translate(0, 0.36, 0);
  const head = new THREE.ConeGeometry(2.6, 0.28, 12).translate(0, 0.86, 0);
  const points: number[] = [];
  const triangles: number[] = [];
  for (const part of [shaft, head]) {
    part.rotateX(Math.PI / 2);
    const first = points.length / 3;
    points.push(...(part.getAttribute('position').array as Float32Array));
    triangles.push(...[...(part.getIndex() as THREE.BufferAttribute).array].map((i) => first + i));
  }
  return { points: new Float32Array(points), triangles: new Uint32Array(triangles) };
}

export class Arrows {
  readonly group = new THREE.Group();
  private readonly arrows = new Batch(MOST);
  private readonly dots = new Batch(MOST);
  private readonly color: Rgb = linear('#d6246e');
  private readonly scales = new Map<Kind, { size: number; perForce: number; longest: number }>();
  count = 0; // points drawn

  constructor(private readonly worlds: Worlds) {
    const { points, triangles } = arrow();
    const ball = new THREE.OctahedronGeometry(1, 1);
    const ballPoints = ball.getAttribute('position').array as Float32Array;
    this.add(this.arrows, points, triangles);
    this.add(this.dots, ballPoints, new Uint32Array(ballPoints.length / 3).map((_, i) => i));
  }

  private add(batch: Batch, points: Float32Array, triangles: Uint32Array): void {
    const mesh = batch.addMesh(points, new Float32Array(points.length), triangles,
      { lit: false, opacity: 1, wireframe: false, shadows: false });
    // They lie between bodies, and would be hidden.
    const material = mesh.material as THREE.Material;
    material.depthTest = false;
    material.transparent = true; // drawn after what is not
    mesh.renderOrder = 6;
    this.group.add(mesh);
  }

  private scaleOf(kind: Kind) {
    let out = this.scales.get(kind);
    if (out === undefined) {
      const moving = kind.bodies.filter((body) => body.row !== null);
      const radius = moving.reduce((sum, body) => sum + body.radius, 0) / (moving.length || 1);
      const side = Math.max(kind.high[0] - kind.low[0], kind.high[1] - kind.low[1]);
      out = { size: 0.05 * radius, perForce: (PER_WEIGHT * radius) / weightOf(kind), longest: 0.5 * side };
      this.scales.set(kind, out);
    }
    return out;
  }

  // Of these cells, as far as there is room.
  update(cells: number[]): void {
    this.arrows.count = this.dots.count = 0;
    const turn = new THREE.Quaternion();
    const up = new THREE.Vector3(0, 0, 1);
    const along = new THREE.Vector3();
    for (const n of cells) {
      const cell = this.worlds.layout.cells[n];
      const kind = this.worlds.kindOf(cell);
      const { size, perForce, longest } = this.scaleOf(kind);
      const lift = this.worlds.planar ? LIFT : 0;
      this.worlds.sources[cell.run].visitContacts(this.worlds.frameOf(cell), cell.kind, cell.world, (_a, _b, x, y, z, nx, ny, nz, force) => {
        if (this.dots.count === MOST) return;
        turn.setFromUnitVectors(up, along.set(nx, ny, nz).normalize());
        const length = Math.min(longest, perForce * force);
        this.put(this.dots, x + cell.x, y + cell.y, z + lift, 2 * size, 2 * size, turn);
        this.put(this.arrows, x + cell.x, y + cell.y, z + lift, size, length, turn);
      });
    }
    this.count = this.dots.count;
    this.arrows.finish();
    this.dots.finish();
  }

  private put(batch: Batch, x: number, y: number, z: number, across: number, along: number, turn: THREE.Quaternion): void {
    const o = STRIDE * batch.count++;
    const out = batch.data;
    out.fill(0, o, o + STRIDE);
    out[o] = x; out[o + 1] = y; out[o + 2] = z;
    out[o + 3] = out[o + 4] = across; out[o + 5] = along;
    out[o + 6] = turn.x; out[o + 7] = turn.y; out[o + 8] = turn.z; out[o + 9] = turn.w;
    out[o + 13] = this.color[0]; out[o + 14] = this.color[1]; out[o + 15] = this.color[2];
  }

  dispose(): void {
    for (const batch of [this.arrows, this.dots]) {
      for (const object of batch.objects) {
        (object as THREE.Mesh).geometry.dispose();
        ((object as THREE.Mesh).material as THREE.Material).dispose();
      }
    }
  }
}
