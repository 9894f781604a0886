// What there is to draw of each kind of world: its shapes, and the batches that hold their instances.
import * as THREE from 'three';

import { Batch, type Look } from './batches';
import { clipPolygon, clipSegment, isInside, type Sides } from './clip';
import { PALETTE, linear, type Rgb } from './colors';
import { emptyPoses, type Body, type Kind, type Mesh, type Poses, type Run } from './data';

export interface Options {
  wireframe: boolean;
  walls: boolean;
  edges: boolean;
  joints: boolean;
}

export interface Drawable {
  body: Body;
  row: number; // -1: fixed
  shape: number;
  batches: Batch[]; // by level
  mesh: Mesh;
  color: Rgb;
  position: number[];
  rotation: number[]; // x y z w
  centred: boolean; // the shape's frame is the body's
  size: number[];
  stretch: number[];
  sizes: Float32Array | null; // [world][6]
}

export interface KindView {
  poses: Poses;
  drawables: Drawable[];
  ground: Batch | null;
  wall: Batch | null;
  tile: Batch | null;
}

function xyzw(wxyz: number[]): number[] {
  return [wxyz[1], wxyz[2], wxyz[3], wxyz[0]];
}

function placed(position: number[], rotation: number[]): THREE.Matrix4 {
  return new THREE.Matrix4().compose(new THREE.Vector3().fromArray(position),
    new THREE.Quaternion().fromArray(xyzw(rotation)), new THREE.Vector3(1, 1, 1));
}

function keyOf(mesh: Mesh): string {
  const points = mesh.levels[0].points;
  let hash = points.length;
  for (const x of points) hash = (hash * 31 + Math.round(x * 1e5)) | 0;
  for (const x of mesh.levels[0].lines) hash = (hash * 31 + Math.round(x * 1e5)) | 0;
  return `${mesh.kind}-${hash}`;
}

function useOf(mesh: Mesh, ghost: boolean, turning: boolean): string {
  return `${keyOf(mesh)}-${ghost}-${turning}`;
}

// Triangles and lines of several shapes in one, cut at `sides` where there are some.
class Merged {
  private readonly points: number[] = [];
  private readonly normals: number[] = [];
  private readonly triangles: number[] = [];
  readonly lines: number[] = [];

  constructor(private readonly sides: Sides | null) {}

  add(mesh: Mesh, size: number[], stretch: number[], place: THREE.Matrix4): void {
    const level = mesh.levels[0];
    const v = new THREE.Vector3();
    const turn = new THREE.Matrix3().getNormalMatrix(place);
    const placed = (from: Float32Array, i: number) => {
      const p = [0, 1, 2].map((c) => from[i + c] * size[c] + stretch[c] * Math.sign(from[i + c]));
      return v.set(p[0], p[1], p[2]).applyMatrix4(place).toArray();
    };
    const vertices: number[][] = []; // with their normals
    for (let i = 0; i < level.points.length; i += 3) {
      const point = placed(level.points, i);
      v.set(level.normals[i] / size[0], level.normals[i + 1] / size[1], level.normals[i + 2] / size[2]);
      vertices.push([...point, ...v.applyMatrix3(turn).normalize().toArray()]);
    }
    const { sides } = this;
    const first = this.points.length / 3;
    for (const vertex of vertices) this.put(vertex);
    const kept = vertices.map((vertex) => sides === null || isInside(vertex, sides));
    for (let t = 0; t < level.triangles.length; t += 3) {
      const corners = [...level.triangles.subarray(t, t + 3)];
      if (sides === null || corners.every((i) => kept[i])) {
        this.triangles.push(...corners.map((i) => first + i));
        continue;
      }
      const polygon = clipPolygon(corners.map((i) => vertices[i]), sides).map((vertex) => this.put(vertex));
      for (let i = 2; i < polygon.length; ++i) this.triangles.push(polygon[0], polygon[i - 1], polygon[i]);
    }
    for (let i = 0; i + 3 < level.lines.length; i += 6) {
      const [a, b] = [placed(level.lines, i), placed(level.lines, i + 3)];
      const left = sides === null ? [a, b] : clipSegment(a, b, sides);
      if (left !== null) this.lines.push(...left[0], ...left[1]);
    }
  }

  private put(vertex: number[]): number {
    this.points.push(vertex[0], vertex[1], vertex[2]);
    this.normals.push(vertex[3], vertex[4], vertex[5]);
    return this.points.length / 3 - 1;
  }

  // Widens low and high by what is drawn.
  bounds(low: number[], high: number[]): void {
    const widen = (from: number[], i: number) => [0, 1, 2].forEach((c) => {
      low[c] = Math.min(low[c], from[i + c]);
      high[c] = Math.max(high[c], from[i + c]);
    });
    for (const i of this.triangles) widen(this.points, 3 * i);
    for (let i = 0; i < this.lines.length; i += 3) widen(this.lines, i);
  }

  get empty(): boolean {
    return this.triangles.length === 0;
  }

  into(batch: Batch, look: Look): THREE.Mesh {
    return batch.addMesh(new Float32Array(this.points), new Float32Array(this.normals),
      new Uint32Array(this.triangles), look);
  }
}

interface MeshUse {
  batches: Batch[]; // by level
  capacity: number;
  mesh: Mesh;
  ghost: boolean;
  turns: boolean; // marks show how it does
}

export class Drawables {
  readonly group = new THREE.Group();
  readonly batches: Batch[] = [];
  readonly kinds: KindView[][]; // [run][kind]
  // m, around what does not move, about the origin of a world.
  readonly still: Sides = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  private readonly known = new Map<string, MeshUse>();
  readonly look: Look;

  // sides: where what does not move is cut, if it is.
  constructor(runs: Run[], ghosts: boolean, private readonly planar: boolean, private readonly options: Options,
    private readonly sides: Sides | null) {
    this.look = { lit: !planar, opacity: 1, wireframe: options.wireframe, shadows: !planar };
    runs.forEach((run, r) => this.count(run, ghosts && r > 0));
    for (const use of this.known.values()) this.addBatches(use);
    this.kinds = runs.map((run, r) => run.kinds.map((kind) => this.view(run, kind, ghosts && r > 0)));
  }

  get objects(): number { // draw calls without shadows
    let out = 0;
    for (const batch of this.batches) for (const object of batch.objects) if (object.visible) ++out;
    return out;
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

  add(batch: Batch): Batch {
    this.batches.push(batch);
    for (const object of batch.objects) this.group.add(object);
    return batch;
  }

  // How many instances there can be of each mesh.
  private count(run: Run, ghost: boolean): void {
    for (const kind of run.kinds) {
      const varied = new Set(kind.sizes.map((one) => one.shape));
      for (const body of kind.bodies) {
        for (const shape of body.shapes) {
          if (shape.mesh < 0 || (body.row === null && !varied.has(shape.shape))) continue;
          const mesh = run.meshes[shape.mesh];
          const key = useOf(mesh, ghost, kind.turns);
          const one = this.known.get(key) ?? { batches: [], capacity: 0, mesh, ghost, turns: kind.turns };
          one.capacity += kind.worlds;
          this.known.set(key, one);
        }
      }
    }
  }

  private addBatches(use: MeshUse): void {
    for (const level of use.mesh.levels) {
      const batch = new Batch(use.capacity);
      if (level.triangles.length > 0) {
        batch.addMesh(level.points, level.normals, level.triangles,
          use.ghost ? { ...this.look, opacity: 0.38, shadows: false } : this.look);
      }
      if ((this.planar || this.options.edges) && level.lines.length > 0 && !use.ghost) {
        batch.addLines(level.lines, this.planar ? 0.8 : 0.35);
      }
      if (this.planar && level.marks.length > 0 && use.turns && !use.ghost) batch.addLines(level.marks, 0.55);
      use.batches.push(this.add(batch));
    }
  }

  private view(run: Run, kind: Kind, ghost: boolean): KindView {
    const view: KindView = { poses: emptyPoses(kind), drawables: [], ground: null, wall: null, tile: null };
    const solid = new Merged(this.sides);
    const wall = new Merged(this.sides);
    kind.bodies.forEach((body, b) => {
      const own = placed(body.position, body.rotation);
      for (const shape of body.shapes) {
        const mesh = run.meshes[shape.mesh];
        const sizes = kind.sizes.find((one) => one.shape === shape.shape)?.values ?? null;
        if (body.row === null && sizes === null) {
          const place = own.clone().multiply(placed(shape.position, shape.rotation));
          (this.isWall(mesh, place, kind) ? wall : solid).add(mesh, shape.size, shape.stretch, place);
          continue;
        }
        const q = xyzw(shape.rotation);
        view.drawables.push({
          body, row: body.row ?? -1, shape: shape.shape,
          batches: this.known.get(useOf(mesh, ghost, kind.turns))!.batches, mesh,
          color: linear(body.row === null ? '#8d99ae' : PALETTE[b % PALETTE.length]),
          position: shape.position, rotation: q,
          centred: shape.position.every((x) => x === 0) && Math.abs(q[3]) === 1,
          size: shape.size, stretch: shape.stretch, sizes,
        });
      }
    });
    for (const merged of [solid, wall]) merged.bounds(this.still.low, this.still.high);
    if (!ghost) this.addStill(view, kind, solid, wall);
    return view;
  }

  // Ground without end that stands rather than lies: seen through, so that it hides no body.
  private isWall(mesh: Mesh, place: THREE.Matrix4, kind: Kind): boolean {
    if (mesh.kind !== 'ground' || this.planar) return false;
    const up = new THREE.Vector3(...kind.gravity).negate();
    if (up.lengthSq() === 0) up.set(0, 0, 1);
    const normals = mesh.levels[0].normals;
    const faces = new THREE.Vector3(normals[0] ?? 0, normals[1] ?? 0, normals[2] ?? 1).transformDirection(place);
    return faces.dot(up.normalize()) < 0.5;
  }

  // What does not move in any world of a kind, one instance each.
  private addStill(view: KindView, kind: Kind, solid: Merged, wall: Merged): void {
    if (this.planar) view.tile = this.addTile(kind);
    if (!solid.empty || solid.lines.length > 0) {
      const batch = new Batch(kind.worlds);
      if (!solid.empty) solid.into(batch, this.look);
      if (this.planar && solid.lines.length > 0) batch.addLines(new Float32Array(solid.lines), 1);
      view.ground = this.add(batch);
    }
    if (!wall.empty && this.options.walls) {
      const batch = new Batch(kind.worlds);
      const mesh = wall.into(batch, { ...this.look, opacity: 0.16, shadows: false });
      mesh.renderOrder = 1;
      batch.addLines(new Float32Array(wall.lines), 0.25);
      view.wall = this.add(batch);
    }
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
}
