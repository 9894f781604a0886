// All worlds of all runs as instances: what to draw for each shape, where, and in which colour.
import * as THREE from 'three';

import { Batch, STRIDE, type Look } from './batches';
import { LOST_COLOR, PALETTE, linear, scaleInto, type Rgb } from './colors';
import { LOST, emptyPoses, speedOf, type Body, type FrameSource, type Kind, type Mesh, type Poses, type Run } from './data';
import { makeLayout, type Cell, type Layout } from './layout';

export type ColorBy = string; // 'body', 'speed', ..., or 'number:NAME'

export interface Theme {
  ground: string;
  wall: string;
  tile: string;
  lost: string;
  selected: string;
  fixed: string;
}

interface Drawable {
  body: Body;
  row: number; // -1: fixed
  shape: number;
  batches: Batch[]; // by level
  color: Rgb;
  position: number[];
  rotation: number[]; // x y z w
  centred: boolean; // the shape's frame is the body's
  size: number[];
  stretch: number[];
  sizes: Float32Array | null; // [world][6]
}

interface KindView {
  poses: Poses;
  drawables: Drawable[];
  ground: Batch | null;
  wall: Batch | null;
  tile: Batch | null;
}

const NEAR_PIXELS = 26; // a body of so many pixels across is drawn finely

function xyzw(wxyz: number[]): number[] {
  return [wxyz[1], wxyz[2], wxyz[3], wxyz[0]];
}

function keyOf(mesh: Mesh): string {
  const points = mesh.levels[0].points;
  let hash = points.length;
  for (const x of points) hash = (hash * 31 + Math.round(x * 1e5)) | 0;
  for (const x of mesh.levels[0].lines) hash = (hash * 31 + Math.round(x * 1e5)) | 0;
  return `${mesh.kind}-${hash}`;
}

// Triangles and lines of several shapes in one.
class Merged {
  private readonly points: number[] = [];
  private readonly normals: number[] = [];
  private readonly triangles: number[] = [];
  readonly lines: number[] = [];

  add(mesh: Mesh, size: number[], stretch: number[], place: THREE.Matrix4): void {
    const level = mesh.levels[0];
    const first = this.points.length / 3;
    const v = new THREE.Vector3();
    const turn = new THREE.Matrix3().getNormalMatrix(place);
    const put = (from: Float32Array, i: number, to: number[]) => {
      const p = [0, 1, 2].map((c) => from[i + c] * size[c] + stretch[c] * Math.sign(from[i + c]));
      v.set(p[0], p[1], p[2]).applyMatrix4(place);
      to.push(v.x, v.y, v.z);
    };
    for (let i = 0; i < level.points.length; i += 3) {
      put(level.points, i, this.points);
      v.set(level.normals[i] / size[0], level.normals[i + 1] / size[1], level.normals[i + 2] / size[2]);
      v.applyMatrix3(turn).normalize();
      this.normals.push(v.x, v.y, v.z);
    }
    for (const t of level.triangles) this.triangles.push(first + t);
    for (let i = 0; i < level.lines.length; i += 3) put(level.lines, i, this.lines);
  }

  get empty(): boolean {
    return this.triangles.length === 0;
  }

  into(batch: Batch, look: Look): THREE.Mesh {
    return batch.addMesh(new Float32Array(this.points), new Float32Array(this.normals),
      new Uint32Array(this.triangles), look);
  }
}

export class Worlds {
  readonly group = new THREE.Group();
  readonly planar: boolean;
  layout!: Layout;
  colorBy: ColorBy = 'body';
  selected = -1; // cell
  maxSpeed = 1; // ends of the scales, of what is shown
  maxSpin = 1;
  private kinds: KindView[][] = []; // [run][kind]
  private readonly batches: Batch[] = [];
  private readonly tinted: { ground: Rgb; wall: Rgb; tile: Rgb; lost: Rgb; selected: Rgb; fixed: Rgb } =
    { ground: [1, 1, 1], wall: [1, 1, 1], tile: [1, 1, 1], lost: [1, 0, 0], selected: [0, 0, 1], fixed: [.5, .5, .5] };
  private readonly frustum = new THREE.Frustum();
  private readonly sphere = new THREE.Sphere();
  private mode = 'body'; // colorBy without the name of the number
  private numbers: { now: Float32Array; low: number; high: number } = { now: new Float32Array(0), low: 0, high: 0 };
  private shown: { frame: number; part: number } = { frame: -1, part: 0 };

  constructor(readonly sources: FrameSource[], readonly ghosts: boolean, aspect: number,
    private readonly options: { wireframe: boolean; walls: boolean; edges: boolean }) {
    const runs = sources.map((source) => source.run);
    this.planar = runs[0].space === 'planar';
    this.layout = makeLayout(runs, ghosts && runs.length > 1, aspect);
    this.build(runs);
  }

  get instances(): number {
    const of = (view: KindView) => view.drawables.filter((d) => d.row >= 0).length;
    let out = 0;
    this.sources.forEach((source, r) => source.run.kinds.forEach((kind, k) => {
      out += kind.worlds * of(this.kinds[r][k]);
    }));
    return out;
  }

  // Shapes of moving bodies that were written last.
  drawn = 0;

  get objects(): number { // draw calls without shadows
    let out = 0;
    for (const batch of this.batches) for (const object of batch.objects) if (object.visible) ++out;
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

  private viewOf(cell: Cell): KindView {
    return this.kinds[cell.run][cell.kind];
  }

  private add(batch: Batch): Batch {
    this.batches.push(batch);
    for (const object of batch.objects) this.group.add(object);
    return batch;
  }

  private build(runs: Run[]): void {
    const look: Look = { lit: !this.planar, opacity: 1, wireframe: this.options.wireframe, shadows: !this.planar };
    const known = new Map<string, { batches: Batch[]; capacity: number; mesh: Mesh; ghost: boolean }>();
    // How many instances there can be of each mesh, then batches of that size.
    const count = (run: Run, ghost: boolean) => {
      for (const kind of run.kinds) {
        const varied = new Set(kind.sizes.map((one) => one.shape));
        for (const body of kind.bodies) {
          for (const shape of body.shapes) {
            if (shape.mesh < 0 || (body.row === null && !varied.has(shape.shape))) continue;
            const mesh = run.meshes[shape.mesh];
            const key = `${keyOf(mesh)}-${ghost}`;
            const one = known.get(key) ?? { batches: [], capacity: 0, mesh, ghost };
            one.capacity += kind.worlds;
            known.set(key, one);
          }
        }
      }
    };
    runs.forEach((run, r) => count(run, this.ghosts && r > 0));
    for (const one of known.values()) {
      one.mesh.levels.forEach((level) => {
        const batch = new Batch(one.capacity);
        if (level.triangles.length > 0) {
          batch.addMesh(level.points, level.normals, level.triangles,
            one.ghost ? { ...look, opacity: 0.38, shadows: false } : look);
        }
        if ((this.planar || this.options.edges) && level.lines.length > 0 && !one.ghost) {
          batch.addLines(level.lines, this.planar ? 0.8 : 0.35);
        }
        if (this.planar && level.marks.length > 0 && !one.ghost) {
          batch.addLines(level.marks, 0.55);
        }
        one.batches.push(this.add(batch));
      });
    }
    this.kinds = runs.map((run, r) => run.kinds.map((kind) => {
      const ghost = this.ghosts && r > 0;
      const view: KindView = {
        poses: emptyPoses(kind), drawables: [], ground: null, wall: null, tile: null,
      };
      const solid = new Merged();
      const wall = new Merged();
      kind.bodies.forEach((body, b) => {
        const own = new THREE.Matrix4().compose(
          new THREE.Vector3(...body.position), new THREE.Quaternion(...xyzw(body.rotation)), new THREE.Vector3(1, 1, 1));
        for (const shape of body.shapes) {
          const mesh = run.meshes[shape.mesh];
          const sizes = kind.sizes.find((one) => one.shape === shape.shape)?.values ?? null;
          if (body.row === null && sizes === null) {
            const place = own.clone().multiply(new THREE.Matrix4().compose(
              new THREE.Vector3(...shape.position), new THREE.Quaternion(...xyzw(shape.rotation)), new THREE.Vector3(1, 1, 1)));
            const up = new THREE.Vector3(...kind.gravity).negate();
            if (up.lengthSq() === 0) up.set(0, 0, 1);
            const normals = mesh.levels[0].normals;
            const faces = new THREE.Vector3(normals[0] ?? 0, normals[1] ?? 0, normals[2] ?? 1)
              .transformDirection(place);
            const see = mesh.kind === 'ground' && !this.planar && faces.dot(up.normalize()) < 0.5;
            (see ? wall : solid).add(mesh, shape.size, shape.stretch, place);
            continue;
          }
          const q = xyzw(shape.rotation);
          view.drawables.push({
            body, row: body.row ?? -1, shape: shape.shape,
            batches: known.get(`${keyOf(mesh)}-${ghost}`)!.batches,
            color: linear(body.row === null ? '#8d99ae' : PALETTE[b % PALETTE.length]),
            position: shape.position, rotation: q,
            centred: shape.position.every((x) => x === 0) && Math.abs(q[3]) === 1,
            size: shape.size, stretch: shape.stretch, sizes,
          });
        }
      });
      if (!ghost) {
        if (this.planar) view.tile = this.addTile(kind);
        if (!solid.empty || solid.lines.length > 0) {
          const batch = new Batch(kind.worlds);
          if (!solid.empty) solid.into(batch, look);
          if (this.planar && solid.lines.length > 0) batch.addLines(new Float32Array(solid.lines), 1);
          view.ground = this.add(batch);
        }
        if (!wall.empty && this.options.walls) {
          const batch = new Batch(kind.worlds);
          const mesh = wall.into(batch, { ...look, opacity: 0.16, shadows: false });
          mesh.renderOrder = 1;
          batch.addLines(new Float32Array(wall.lines), 0.25);
          view.wall = this.add(batch);
        }
      }
      return view;
    }));
  }

  // What lies behind a planar world.
  private addTile(kind: Kind): Batch {
    const [l, b] = kind.low;
    const [r, t] = kind.high;
    const batch = new Batch(kind.worlds);
    const mesh = batch.addMesh(new Float32Array([l, b, 0, r, b, 0, r, t, 0, l, t, 0]),
      new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]), new Uint32Array([0, 1, 2, 0, 2, 3]),
      { lit: false, opacity: 1, wireframe: false, shadows: false });
    mesh.renderOrder = -1;
    return this.add(batch);
  }

  setTheme(theme: Theme): void {
    for (const name of Object.keys(theme) as (keyof Theme)[]) this.tinted[name] = linear(theme[name]);
  }

  dispose(): void {
    for (const batch of this.batches) {
      for (const object of batch.objects) {
        const mesh = object as THREE.Mesh;
        mesh.geometry.dispose();
        (mesh.material as THREE.Material).dispose();
      }
    }
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
      this.kinds[r].forEach((view, k) => source.read(frame, part, k, view.poses));
      if (r === 0) this.shown = { frame, part };
      // The chunk after the next frames, before it is wanted.
      const soon = Math.min(frame + 20, source.frames - 1);
      if (!source.ready(soon)) void source.prepare(soon);
    });
    return all;
  }

  get frame(): number {
    return this.shown.frame;
  }

  // Colour of a body as the eye gets it without shading, linear.
  private colorInto(cell: Cell, poses: Poses, drawable: Drawable, item: number, out: Float32Array, at: number): void {
    if (drawable.row < 0) {
      put(this.tinted.fixed, out, at);
      return;
    }
    switch (this.mode) {
      case 'speed':
        scaleInto(speedOf(this.runOf(cell), poses.speed[item]) / this.maxSpeed, out, at);
        break;
      case 'spin':
        scaleInto(speedOf(this.runOf(cell), poses.spin[item]) / this.maxSpin, out, at);
        break;
      case 'rest':
        put(poses.speed[item] === 0 && poses.spin[item] === 0 ? REST : AWAKE, out, at);
        break;
      case 'height': {
        const up = this.planar ? 1 : 2;
        const x = poses.position[3 * item + up];
        scaleInto((x - this.layout.low[up]) / (this.layout.high[up] - this.layout.low[up]), out, at);
        break;
      }
      case 'run':
        put(RUNS[cell.run % RUNS.length], out, at);
        break;
      case 'number':
        scaleInto(this.numberOf(cell), out, at);
        break;
      default:
        put(drawable.color, out, at);
    }
    if ((poses.status[cell.world] & LOST) !== 0) {
      for (let c = 0; c < 3; ++c) out[at + c] = 0.25 * out[at + c] + 0.75 * LOST_RGB[c];
    }
  }

  private get number(): Float32Array | undefined {
    return this.sources[0].run.numbers.find((one) => `number:${one.name}` === this.colorBy)?.values;
  }

  // Where the scale of the recorded number ends at this frame.
  private findNumberEnds(): void {
    this.mode = this.colorBy.startsWith('number:') ? 'number' : this.colorBy;
    const values = this.number;
    if (values === undefined) return;
    const worlds = this.sources[0].run.kinds.reduce((sum, kind) => sum + kind.worlds, 0);
    const now = values.subarray(this.shown.frame * worlds, (this.shown.frame + 1) * worlds);
    let low = Infinity;
    let high = -Infinity;
    for (const x of now) {
      if (x < low) low = x;
      if (x > high) high = x;
    }
    this.numbers = { now, low, high };
  }

  // 0 to 1 of the recorded number of a world; the other recordings have none.
  private numberOf(cell: Cell): number {
    if (cell.run > 0) return 0;
    const first = this.sources[0].run.kinds.slice(0, cell.kind).reduce((sum, kind) => sum + kind.worlds, 0);
    const { now, low, high } = this.numbers;
    return (now[first + cell.world] - low) / (high - low || 1);
  }

  // The ends of the recorded number's scale.
  get numberEnds(): [number, number] {
    return [this.numbers.low, this.numbers.high];
  }

  // Writes all instances that `camera` sees.
  write(camera: THREE.Camera, pixels: number): void {
    for (const batch of this.batches) batch.count = 0;
    this.drawn = 0;
    this.findNumberEnds();
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
      this.sphere.radius = 1.3 * reach;
      if (!this.frustum.intersectsSphere(this.sphere)) continue;
      const distance = this.planar ? 0 : Math.max(1e-6, this.sphere.center.distanceTo(eye) - reach);
      this.writeCell(cell, n, this.planar ? pixels : pixels / distance);
    }
    for (const batch of this.batches) batch.finish();
  }

  // scale: pixels per m.
  private writeCell(cell: Cell, n: number, scale: number): void {
    const view = this.viewOf(cell);
    const kind = this.kindOf(cell);
    const { position, rotation, there } = view.poses;
    const lost = this.isLost(cell);
    const tint = lost ? this.tinted.lost : n === this.selected ? this.tinted.selected : null;
    if (view.ground !== null) putStill(view.ground, cell, tint ?? (this.planar ? this.tinted.fixed : this.tinted.ground), 0);
    if (view.tile !== null) putStill(view.tile, cell, tint ?? this.tinted.tile, this.planar ? -50 : 0);
    if (view.wall !== null) putStill(view.wall, cell, tint ?? this.tinted.wall, 0);
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
      this.colorInto(cell, view.poses, d, item, out, o + 13);
    }
  }

  // The body under a ray: exact, triangle by triangle, of shapes whose spheres it meets.
  pick(ray: THREE.Ray): { cell: number; row: number } | null {
    let best = Infinity;
    let found: { cell: number; row: number } | null = null;
    const q = new THREE.Quaternion();
    const center = new THREE.Vector3();
    const local = new THREE.Ray();
    const hit = new THREE.Vector3();
    const abc = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    const cells = this.layout.cells;
    for (let n = 0; n < cells.length; ++n) {
      const cell = cells[n];
      const view = this.viewOf(cell);
      const kind = this.kindOf(cell);
      for (const d of view.drawables) {
        if (d.row < 0) continue;
        const item = cell.world * kind.rows + d.row;
        if (view.poses.there[item] === 0) continue;
        const p = view.poses.position;
        center.set(p[3 * item] + cell.x, p[3 * item + 1] + cell.y, this.planar ? 0 : p[3 * item + 2]);
        if (ray.distanceSqToPoint(center) > (1.01 * d.body.radius) ** 2) continue;
        q.fromArray(view.poses.rotation, 4 * item);
        const shapeAt = new THREE.Vector3(...d.position).applyQuaternion(q).add(center);
        q.multiply(new THREE.Quaternion(...d.rotation)).invert();
        local.origin.copy(ray.origin).sub(shapeAt).applyQuaternion(q);
        local.direction.copy(ray.direction).applyQuaternion(q);
        const mesh = this.runOf(cell).meshes[d.body.shapes.find((s) => s.shape === d.shape)!.mesh];
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
          const far = hit.distanceTo(local.origin) - (this.planar ? 0.01 * d.row : 0);
          if (far < best) {
            best = far;
            found = { cell: n, row: d.row };
          }
        }
      }
    }
    return found;
  }

  // The world whose cell a ray meets first, on the ground or, in the plane, at z = 0.
  pickCell(ray: THREE.Ray): number {
    const { low, high, cells } = this.layout;
    const box = new THREE.Box3();
    const hit = new THREE.Vector3();
    let best = Infinity;
    let found = -1;
    cells.forEach((cell, n) => {
      box.min.set(cell.x + low[0], cell.y + low[1], this.planar ? -1 : low[2]);
      box.max.set(cell.x + high[0], cell.y + high[1], this.planar ? 1 : low[2] + 0.5 * (high[2] - low[2]));
      if (ray.intersectBox(box, hit) === null) return;
      const far = hit.distanceTo(ray.origin);
      if (far < best) {
        best = far;
        found = n;
      }
    });
    return found;
  }

  // Where a body is drawn.
  placeOf(cell: number, row: number, out: THREE.Vector3): THREE.Vector3 {
    const one = this.layout.cells[cell];
    const item = one.world * this.kindOf(one).rows + row;
    const p = this.posesOf(one).position;
    return out.set(p[3 * item] + one.x, p[3 * item + 1] + one.y, this.planar ? 0 : p[3 * item + 2]);
  }

  // The plain colour of a body, as bytes of sRGB.
  colorOf(cell: number, row: number): number[] {
    const one = this.layout.cells[cell];
    const view = this.viewOf(one);
    const d = view.drawables.find((drawable) => drawable.row === row);
    const rgb = new Float32Array(3);
    if (d !== undefined) this.colorInto(one, view.poses, d, one.world * this.kindOf(one).rows + row, rgb, 0);
    const color = new THREE.Color(rgb[0], rgb[1], rgb[2]);
    return [...color.convertLinearToSRGB()].map((c) => Math.round(255 * c));
  }

  // The ends of the scales: the fastest body of this moment, but never less than before.
  widenScales(): void {
    this.sources.forEach((source, r) => this.kinds[r].forEach((view) => {
      let speed = 0;
      let spin = 0;
      for (const code of view.poses.speed) if (code > speed) speed = code;
      for (const code of view.poses.spin) if (code > spin) spin = code;
      this.maxSpeed = Math.max(this.maxSpeed, speedOf(source.run, speed));
      this.maxSpin = Math.max(this.maxSpin, speedOf(source.run, spin));
    }));
  }
}

const LOST_RGB = linear(LOST_COLOR);
const REST = linear('#5b6f8f');
const AWAKE = linear('#f3a712');
const RUNS = ['#3f6fb5', '#f3a712', '#76b041', '#8f5aa8'].map(linear);

function put(color: Rgb, out: Float32Array, at: number): void {
  out[at] = color[0];
  out[at + 1] = color[1];
  out[at + 2] = color[2];
}

function putStill(batch: Batch, cell: Cell, color: Rgb, z: number): void {
  const o = STRIDE * batch.count++;
  const out = batch.data;
  out.fill(0, o, o + STRIDE);
  out[o] = cell.x;
  out[o + 1] = cell.y;
  out[o + 2] = z;
  out[o + 3] = out[o + 4] = out[o + 5] = out[o + 9] = 1;
  put(color, out, o + 13);
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
