// All worlds of all runs as instances: what to draw for each shape, where, and in which colour.
import * as THREE from 'three';

import { STRIDE, type Batch } from './batches';
import { Coloring, put, type Theme } from './coloring';
import type { Rgb } from './colors';
import { LOST, type FrameSource, type Kind, type Poses, type Run } from './data';
import { Drawables, type KindView, type Options } from './drawables';
import { Joints } from './joints';
import { makeLayout, sidesOf, type Cell, type Layout } from './layout';

const NEAR_PIXELS = 26; // a body of so many pixels across is drawn finely
const FADED = 0.7; // how far the neighbours of the chosen world fade into the background

export class Worlds {
  readonly planar: boolean;
  readonly layout: Layout;
  readonly coloring: Coloring;
  selected = -1; // cell, which is tinted
  focus = -1; // cell whose neighbours are faded
  drawn = 0; // shapes of moving bodies that were written last
  readonly seen: number[] = []; // cells that the camera saw then
  private readonly drawables: Drawables;
  private readonly joints: Joints | null;
  private readonly frustum = new THREE.Frustum();
  private readonly sphere = new THREE.Sphere();
  private shown: { frame: number; part: number } = { frame: -1, part: 0 };
  private readonly frames: number[] = []; // of each run, shown

  constructor(readonly sources: FrameSource[], ghosts: boolean, aspect: number, options: Options) {
    const runs = sources.map((source) => source.run);
    this.planar = runs[0].space === 'planar';
    this.layout = makeLayout(runs, ghosts && runs.length > 1, aspect);
    this.drawables = new Drawables(runs, ghosts, this.planar, options, sidesOf(this.layout));
    this.coloring = new Coloring(sources, this.planar, this.layout);
    this.joints = options.joints
      ? new Joints(runs, this.coloring, this.planar, this.layout, { ...this.drawables.look, wireframe: false }, (batch) => this.drawables.add(batch))
      : null;
  }

  get group(): THREE.Group {
    return this.drawables.group;
  }
  get still(): { low: number[]; high: number[] } {
    return this.drawables.still;
  }
  get objects(): number { // draw calls without shadows
    return this.drawables.objects;
  }
  get jointsDrawn(): number {
    return this.joints?.drawn ?? 0;
  }
  get jointPieces() {
    return this.joints?.pieces ?? {};
  }
  get instances(): number {
    const of = (view: KindView) => view.drawables.filter((d) => d.row >= 0).length;
    let out = 0;
    this.sources.forEach((source, r) => source.run.kinds.forEach((kind, k) => {
      out += kind.worlds * of(this.drawables.kinds[r][k]);
    }));
    return out;
  }

  runOf(cell: Cell): Run {
    return this.sources[cell.run].run;
  }
  kindOf(cell: Cell): Kind {
    return this.runOf(cell).kinds[cell.kind];
  }
  posesOf(cell: Cell): Poses {
    return this.viewOf(cell).poses;
  }
  isLost(cell: Cell): boolean {
    return (this.posesOf(cell).status[cell.world] & LOST) !== 0;
  }

  viewOf(cell: Cell): KindView {
    return this.drawables.kinds[cell.run][cell.kind];
  }

  setTheme(theme: Theme): void {
    this.coloring.setTheme(theme);
  }
  dispose(): void {
    this.drawables.dispose();
  }
  widenScales(): void {
    this.coloring.widen(this.drawables.kinds);
  }

  // Poses of a moment, of all runs that go on so long; those that have ended stay at their end.
  read(time: number): boolean {
    let all = true;
    this.sources.forEach((source, r) => {
      const { frame, part } = momentOf(source, time);
      if (!source.ready(frame) || (part > 0 && !source.ready(frame + 1))) {
        void source.prepare(frame);
        if (part > 0) void source.prepare(frame + 1);
        all = false;
        return;
      }
      this.drawables.kinds[r].forEach((view, k) => {
        source.read(frame, part, k, view.poses);
        if (this.coloring.by === 'contact') addForces(source, frame, k, view.poses);
      });
      this.frames[r] = frame;
      if (r === 0) this.shown = { frame, part };
      // The chunk after the next frames, before it is wanted.
      const soon = Math.min(frame + 20, source.frames - 1);
      if (!source.ready(soon)) void source.prepare(soon);
    });
    return all;
  }

  frameOf(cell: Cell): number {
    return this.frames[cell.run] ?? 0;
  }
  get frame(): number {
    return this.shown.frame;
  }

  // Writes all instances that `camera` sees.
  write(camera: THREE.Camera, pixels: number): void {
    for (const batch of this.drawables.batches) batch.count = 0;
    this.drawn = 0;
    if (this.joints !== null) this.joints.drawn = 0;
    this.seen.length = 0;
    this.coloring.findNumberEnds(this.shown.frame);
    this.frustum.setFromProjectionMatrix(new THREE.Matrix4().multiplyMatrices(
      camera.projectionMatrix, camera.matrixWorldInverse));
    const { low, high } = this.layout;
    const middle = [0, 1, 2].map((c) => (low[c] + high[c]) / 2);
    const reach = 0.5 * Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    const eye = camera.position;
    const cells = this.layout.cells;
    for (let n = 0; n < cells.length; ++n) {
      const cell = cells[n];
      this.sphere.center.set(cell.x + middle[0], cell.y + middle[1], middle[2]);
      this.sphere.radius = 1.3 * reach + this.strayed(cell, middle, reach);
      if (n !== this.selected && !this.frustum.intersectsSphere(this.sphere)) continue;
      this.seen.push(n);
      const distance = this.planar ? 0 : Math.max(1e-6, this.sphere.center.distanceTo(eye) - reach);
      this.writeCell(cell, n, this.planar ? pixels : pixels / distance);
    }
    for (const batch of this.drawables.batches) batch.finish();
  }

  // m, how far the first body of a world is out of its room: a robot's trunk, say.
  private strayed(cell: Cell, middle: number[], reach: number): number {
    const { rows } = this.kindOf(cell);
    if (rows === 0) return 0;
    const { position } = this.posesOf(cell);
    const at = 3 * rows * cell.world;
    const away = Math.hypot(position[at] - middle[0], position[at + 1] - middle[1], position[at + 2] - middle[2]);
    return away < 1e4 * reach ? Math.max(0, away - reach) : 0; // what is lost may be anywhere
  }

  // scale: pixels per m.
  private writeCell(cell: Cell, n: number, scale: number): void {
    const view = this.viewOf(cell);
    const kind = this.kindOf(cell);
    const { position, rotation, there } = view.poses;
    const lost = this.isLost(cell);
    const fade = this.fadeOf(cell);
    const tint = lost ? this.coloring.tints.lost : n === this.selected ? this.coloring.tints.selected : null;
    if (view.ground !== null) putStill(view.ground, cell, tint ?? (this.planar ? this.coloring.tints.fixed : this.coloring.tints.ground), 0, fade);
    if (view.tile !== null) putStill(view.tile, cell, tint ?? this.coloring.tints.tile, this.planar ? -50 : 0, fade);
    if (view.wall !== null) putStill(view.wall, cell, tint ?? this.coloring.tints.wall, 0, fade);
    if (!cell.ghost) this.joints?.write(cell, view.poses, fade);
    const first = cell.world * kind.rows;
    for (let i = 0; i < view.drawables.length; ++i) {
      const d = view.drawables[i];
      const item = d.row < 0 ? -1 : first + d.row;
      if (item >= 0 && there[item] === 0) continue;
      const level = d.batches.length > 1 && 2 * d.body.radius * scale < NEAR_PIXELS ? 1 : 0;
      if (item >= 0) ++this.drawn;
      const batch = d.batches[level];
      const out = batch.data;
      const o = STRIDE * batch.count++;
      let px: number, py: number, pz: number, qx: number, qy: number, qz: number, qw: number;
      if (item >= 0) {
        px = position[3 * item]; py = position[3 * item + 1]; pz = position[3 * item + 2];
        qx = rotation[4 * item]; qy = rotation[4 * item + 1]; qz = rotation[4 * item + 2]; qw = rotation[4 * item + 3];
      } else {
        const { position: at, rotation: turn } = d.body;
        px = at[0]; py = at[1]; pz = at[2];
        qw = turn[0]; qx = turn[1]; qy = turn[2]; qz = turn[3];
      }
      if (!d.centred) {
        const sx = d.position[0], sy = d.position[1], sz = d.position[2];
        const tx = qy * sz - qz * sy + qw * sx;
        const ty = qz * sx - qx * sz + qw * sy;
        const tz = qx * sy - qy * sx + qw * sz;
        px += sx + 2 * (qy * tz - qz * ty);
        py += sy + 2 * (qz * tx - qx * tz);
        pz += sz + 2 * (qx * ty - qy * tx);
        const rx = d.rotation[0], ry = d.rotation[1], rz = d.rotation[2], rw = d.rotation[3];
        const x = qw * rx + qx * rw + qy * rz - qz * ry;
        const y = qw * ry - qx * rz + qy * rw + qz * rx;
        const z = qw * rz + qx * ry - qy * rx + qz * rw;
        qw = qw * rw - qx * rx - qy * ry - qz * rz;
        qx = x; qy = y; qz = z;
      }
      out[o] = px + cell.x;
      out[o + 1] = py + cell.y;
      // In the plane later bodies lie on earlier ones.
      out[o + 2] = this.planar ? 0.01 * i + (cell.ghost ? 20 : 0) : pz;
      if (d.sizes === null) {
        out[o + 3] = d.size[0]; out[o + 4] = d.size[1]; out[o + 5] = d.size[2];
        out[o + 10] = d.stretch[0]; out[o + 11] = d.stretch[1]; out[o + 12] = d.stretch[2];
      } else {
        const s = 6 * cell.world;
        out[o + 3] = d.sizes[s]; out[o + 4] = d.sizes[s + 1]; out[o + 5] = d.sizes[s + 2];
        out[o + 10] = d.sizes[s + 3]; out[o + 11] = d.sizes[s + 4]; out[o + 12] = d.sizes[s + 5];
      }
      out[o + 6] = qx; out[o + 7] = qy; out[o + 8] = qz; out[o + 9] = qw;
      this.coloring.into(cell, view.poses, d, item, out, o + 13);
      out[o + 16] = fade;
    }
  }

  // The same world of another recording is compared with the chosen one, so it does not fade.
  fadeOf(cell: Cell): number {
    if (this.focus < 0) return 0;
    const chosen = this.layout.cells[this.focus];
    return cell.kind === chosen.kind && cell.world === chosen.world ? 0 : FADED;
  }

  // Where a body is drawn.
  placeOf(cell: number, row: number, out: THREE.Vector3): THREE.Vector3 {
    const one = this.layout.cells[cell];
    const item = one.world * this.kindOf(one).rows + row;
    const p = this.posesOf(one).position;
    return out.set(p[3 * item] + one.x, p[3 * item + 1] + one.y, this.planar ? 0 : p[3 * item + 2]);
  }

  // Around the moving bodies of a world, as they are drawn.
  boxOf(cell: number): THREE.Box3 {
    const box = new THREE.Box3();
    const place = new THREE.Vector3();
    this.forBodies(cell, (row, radius) => {
      box.union(new THREE.Box3().setFromCenterAndSize(this.placeOf(cell, row, place), new THREE.Vector3().setScalar(2 * radius)));
    });
    return box;
  }

  // The middle of their masses.
  centerOf(cell: number, out: THREE.Vector3): THREE.Vector3 {
    const place = new THREE.Vector3();
    let all = 0;
    out.set(0, 0, 0);
    this.forBodies(cell, (row, _radius, mass) => {
      out.addScaledVector(this.placeOf(cell, row, place), mass);
      all += mass;
    });
    return out.divideScalar(all || 1);
  }

  // Those that move and are there.
  private forBodies(cell: number, visit: (row: number, radius: number, mass: number) => void): void {
    const one = this.layout.cells[cell];
    const kind = this.kindOf(one);
    const { there } = this.posesOf(one);
    for (const { row, radius, mass } of kind.bodies) {
      if (row !== null && there[one.world * kind.rows + row] !== 0) visit(row, radius, Math.max(mass, 1e-9));
    }
  }

  // The plain colour of a body, as bytes of sRGB.
  colorOf(cell: number, row: number): number[] {
    const one = this.layout.cells[cell];
    const view = this.viewOf(one);
    const d = view.drawables.find((drawable) => drawable.row === row);
    const rgb = new Float32Array(3);
    if (d !== undefined) this.coloring.into(one, view.poses, d, one.world * this.kindOf(one).rows + row, rgb, 0);
    const color = new THREE.Color(rgb[0], rgb[1], rgb[2]);
    return [...color.convertLinearToSRGB()].map((c) => Math.round(255 * c));
  }

}

function putStill(batch: Batch, cell: Cell, color: Rgb, z: number, fade: number): void {
  const o = STRIDE * batch.count++;
  const out = batch.data;
  out.fill(0, o, o + STRIDE);
  out[o] = cell.x;
  out[o + 1] = cell.y;
  out[o + 2] = z;
  out[o + 3] = out[o + 4] = out[o + 5] = out[o + 9] = 1;
  put(color, out, o + 13);
  out[o + 16] = fade;
}

// What contacts press with on each body.
function addForces(source: FrameSource, frame: number, kindIndex: number, poses: Poses): void {
  const kind = source.run.kinds[kindIndex];
  const rows = kind.bodies.map((body) => body.row);
  poses.force.fill(0);
  for (let world = 0; world < kind.worlds; ++world) {
    source.visitContacts(frame, kindIndex, world, (a, b, _x, _y, _z, _nx, _ny, _nz, force) => {
      for (const row of [rows[a], rows[b]]) if (row !== null) poses.force[world * kind.rows + row] += force;
    });
  }
}

export function momentOf(source: FrameSource, time: number): { frame: number; part: number } {
  const last = source.frames - 1;
  if (last <= 0 || time >= source.time(last)) return { frame: last, part: 0 };
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (source.time(middle) <= time) low = middle;
    else high = middle;
  }
  const part = (time - source.time(low)) / (source.time(high) - source.time(low));
  return { frame: low, part: part < 1e-6 || part > 1 ? 0 : part };
}
