// What is drawn over worlds: contacts, and lines over the chosen one: trails, joints with their axes, centres of mass, its borders.
import * as THREE from 'three';

import { Arrows } from './arrows';
import { boundsOf } from './bounds';
import { linear } from './colors';
import type { Worlds } from './worlds';

const TRAIL_SECONDS = 2;
const TRAIL_FRAMES = 90;

class Lines {
  readonly object: THREE.LineSegments;
  private points: number[] = [];
  private colors: number[] = [];

  constructor(private readonly worlds: Worlds, behind: boolean) {
    this.object = new THREE.LineSegments(new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, depthTest: behind, depthWrite: false }));
    this.object.frustumCulled = false;
    this.object.renderOrder = 5;
  }

  add(a: THREE.Vector3, b: THREE.Vector3, color: number[], alpha = 1): void {
    const lift = this.worlds.planar ? 40 : 0;
    this.points.push(a.x, a.y, a.z + lift, b.x, b.y, b.z + lift);
    this.colors.push(...color, alpha, ...color, alpha);
  }

  finish(): void {
    const { geometry } = this.object;
    geometry.dispose();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(this.points, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(this.colors, 4));
    this.object.visible = this.points.length > 0;
    this.points = [];
    this.colors = [];
  }
}

export interface Chosen {
  cell: number; // -1: none
  row: number; // -1: none
}

export class Overlays {
  readonly group = new THREE.Group();
  trails = false;
  anchors = false;
  centers = false;
  bounds = false;
  contacts = false;
  axes = true; // of the chosen body
  pull: { from: THREE.Vector3; to: THREE.Vector3 } | null = null; // the spring of a drag
  private readonly hidden: Lines; // by what is before them
  private readonly above: Lines;
  private readonly arrows: Arrows;

  constructor(private readonly worlds: Worlds) {
    this.hidden = new Lines(worlds, true);
    this.above = new Lines(worlds, false);
    this.arrows = new Arrows(worlds);
    this.group.add(this.hidden.object, this.above.object, ...this.arrows.group.children);
  }

  get objects(): number {
    return this.group.children.filter((child) => child.visible).length;
  }

  update(chosen: Chosen): void {
    if (chosen.cell >= 0) {
      if (this.trails) this.addTrails(chosen);
      if (this.anchors) this.addAnchors(chosen.cell);
      if (this.centers) this.addCenters(chosen.cell);
      if (this.bounds) this.addBounds(chosen.cell);
      if (this.axes && chosen.row >= 0) this.addFrame(chosen);
    }
    if (this.pull !== null) this.above.add(this.pull.from, this.pull.to, linear('#e02b2b'));
    // Of all that are seen while none is chosen.
    this.arrows.update(!this.contacts ? [] : chosen.cell >= 0 ? [chosen.cell] : this.worlds.seen);
    this.hidden.finish();
    this.above.finish();
  }

  get contactsDrawn(): number {
    return this.arrows.count;
  }
  dispose(): void {
    this.arrows.dispose();
  }

  private addTrails(chosen: Chosen): void {
    const cell = this.worlds.layout.cells[chosen.cell];
    const source = this.worlds.sources[cell.run];
    const kind = this.worlds.kindOf(cell);
    const now = this.worlds.frame;
    const from = new THREE.Vector3();
    const to = new THREE.Vector3();
    const at = [0, 0, 0];
    for (let row = 0; row < kind.rows; ++row) {
      if (chosen.row >= 0 && row !== chosen.row) continue;
      const color = this.worlds.colorOf(chosen.cell, row).map((c) => (c / 255) ** 2.2);
      this.worlds.placeOf(chosen.cell, row, from);
      for (let frame = now; frame >= Math.max(0, now - TRAIL_FRAMES); --frame) {
        const age = source.time(now) - source.time(frame);
        if (age > TRAIL_SECONDS || !source.ready(frame)) break;
        if (!source.positionAt(frame, cell.kind, cell.world * kind.rows + row, at)) break;
        to.set(at[0] + cell.x, at[1] + cell.y, this.worlds.planar ? 0 : at[2]);
        this.hidden.add(from, to, color, 1 - age / TRAIL_SECONDS);
        from.copy(to);
      }
    }
  }

  // The frame of a body in the world, as drawn.
  private frameOf(cellIndex: number, body: number | null, q: THREE.Quaternion, p: THREE.Vector3): void {
    const cell = this.worlds.layout.cells[cellIndex];
    const kind = this.worlds.kindOf(cell);
    const one = body === null ? null : kind.bodies[body];
    if (one === null || one.row === null) {
      const [w, x, y, z] = one?.rotation ?? [1, 0, 0, 0];
      q.set(x, y, z, w);
      p.set(cell.x, cell.y, 0);
      if (one !== null) p.add(new THREE.Vector3(...one.position));
      return;
    }
    q.fromArray(this.worlds.posesOf(cell).rotation, 4 * (cell.world * kind.rows + one.row));
    this.worlds.placeOf(cellIndex, one.row, p);
  }

  private addAnchors(cellIndex: number): void {
    const cell = this.worlds.layout.cells[cellIndex];
    const kind = this.worlds.kindOf(cell);
    const q = new THREE.Quaternion();
    const p = new THREE.Vector3();
    const ends = [new THREE.Vector3(), new THREE.Vector3()];
    const color = linear('#d1396a');
    const axisColor = linear('#2aa6a1');
    for (const joint of kind.joints) {
      [joint.a, joint.b].forEach((end, i) => {
        if (end === null) return;
        this.frameOf(cellIndex, end.body, q, p);
        ends[i].set(end.position[0], end.position[1], end.position[2]).applyQuaternion(q).add(p);
        if (end.body !== null) this.above.add(p.clone(), ends[i], color, 0.55);
        if (i === 0 && (joint.type === 'hinge' || joint.type === 'slider' || joint.type === 'wheel') && !this.worlds.planar) {
          const [w, x, y, z] = end.rotation;
          const axis = joint.type === 'hinge' ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
          axis.applyQuaternion(new THREE.Quaternion(x, y, z, w)).applyQuaternion(q);
          const length = 0.5 * (kind.bodies[joint.body_b ?? joint.body_a ?? 0]?.radius ?? 0.1);
          this.above.add(ends[0].clone().addScaledVector(axis, -length), ends[0].clone().addScaledVector(axis, length), axisColor);
        }
      });
      if (['distance', 'target'].includes(joint.type)) this.above.add(ends[0].clone(), ends[1].clone(), color);
    }
  }

  private addCenters(cellIndex: number): void {
    const cell = this.worlds.layout.cells[cellIndex];
    const kind = this.worlds.kindOf(cell);
    const q = new THREE.Quaternion();
    const p = new THREE.Vector3();
    const color = linear('#111827');
    kind.bodies.forEach((body, b) => {
      if (body.motion !== 'dynamic') return;
      this.frameOf(cellIndex, b, q, p);
      p.add(new THREE.Vector3(...body.center).applyQuaternion(q));
      const size = 0.16 * body.radius;
      for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
        const along = new THREE.Vector3(...axis).multiplyScalar(size);
        this.above.add(p.clone().sub(along), p.clone().add(along), color);
      }
    });
  }

  private addBounds(cellIndex: number): void {
    const corner = (box: THREE.Box3, i: number) => new THREE.Vector3(
      (i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y, this.worlds.planar ? 0 : (i & 4 ? box.max : box.min).z);
    for (const [row, box] of boundsOf(this.worlds, cellIndex)) {
      // Darker than the body, since the box of a box at rest is its edges.
      const color = this.worlds.colorOf(cellIndex, row).map((c) => 0.4 * (c / 255) ** 2.2);
      for (let i = 0; i < (this.worlds.planar ? 4 : 8); ++i) {
        for (const axis of this.worlds.planar ? [1, 2] : [1, 2, 4]) {
          if ((i & axis) === 0) this.hidden.add(corner(box, i), corner(box, i | axis), color);
        }
      }
    }
  }

  // Axes of the chosen body: x red, y green, z blue.
  private addFrame(chosen: Chosen): void {
    const cell = this.worlds.layout.cells[chosen.cell];
    const kind = this.worlds.kindOf(cell);
    const b = kind.bodies.findIndex((body) => body.row === chosen.row);
    const q = new THREE.Quaternion();
    const p = new THREE.Vector3();
    this.frameOf(chosen.cell, b, q, p);
    ['#e02b2b', '#1e9e4a', '#2f6fde'].forEach((hex, axis) => {
      if (this.worlds.planar && axis === 2) return;
      const along = new THREE.Vector3().setComponent(axis, 1.35 * kind.bodies[b].radius).applyQuaternion(q);
      this.above.add(p.clone(), p.clone().add(along), linear(hex));
    });
  }
}
