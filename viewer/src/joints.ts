// Draws the joints of all worlds, each as what it is: ropes, rods and springs from anchor to anchor, pulleys with their
// wheels, hinges as pins, sliders as rails.
import * as THREE from 'three';

import { Batch, STRIDE, type Look } from './batches';
import { clipSegment, type Sides } from './clip';
import { put, type Coloring } from './coloring';
import type { Rgb } from './colors';
import type { Body, Joint, JointEnd, Kind, Poses, Run } from './data';
import { unitMeshes, type UnitName } from './joint_meshes';
import type { Cell } from './layout';
import { polyline, ropePoints } from './rope';

// Of the radius of the smaller body.
const ROPE = 0.045;
const ROD = 0.07;
const PIN = 0.1;
const POKE = 0.06; // how far a pin comes out of the narrower body
const LONG = 0.35; // half of a pin's length at most
const SHORT = 0.15;
const SPRING = 0.16;
const WHEEL = 0.3;
const ABOVE = 15; // in the plane: over bodies, below ghosts
const ROPE_PIECES = 14;

type Pieces = Partial<Record<UnitName, number>>;

// How many instances a joint is made of at most.
function piecesOf(joint: Joint, planar: boolean): Pieces {
  const pin: Pieces = planar ? { ring: 1 } : { bar: 1 };
  switch (joint.type) {
    case 'ball': return { ball: 1 };
    case 'hinge': return pin;
    case 'slider': return { bar: 1, block: 1 };
    case 'fixed': return { block: 1 };
    case 'wheel': return { ...pin, spring: 1 };
    case 'pulley': return { bar: 3, ring: 2 };
    case 'target': return { spring: 1, ball: 1 };
    case 'distance': {
      const forms = { spring: { spring: 1 }, rope: { bar: ROPE_PIECES }, telescope: { bar: 2 }, rod: { bar: 1, ball: 2 } };
      return forms[joint.form ?? 'rod'];
    }
    default: return {};
  }
}

interface JointPlan {
  joint: Joint;
  radius: number; // m, of the smaller body
  pin: [number, number]; // m, along z of the joint's frame, from where to where
}

// m, from where to where a body goes along an axis of its frame, about a point of it.
function extentOf(run: Run, body: Body, from: THREE.Vector3, axis: THREE.Vector3): [number, number] {
  let [low, high] = [0, 0];
  const p = new THREE.Vector3();
  for (const shape of body.shapes) {
    const [w, x, y, z] = shape.rotation;
    const turn = new THREE.Quaternion(x, y, z, w);
    const { points } = run.meshes[shape.mesh].levels[0];
    for (let i = 0; i < points.length; i += 3) {
      p.set(...[0, 1, 2].map((c) => points[i + c] * shape.size[c] + shape.stretch[c] * Math.sign(points[i + c])) as [number, number, number]);
      p.applyQuaternion(turn).add(new THREE.Vector3(...shape.position)).sub(from);
      low = Math.min(low, p.dot(axis));
      high = Math.max(high, p.dot(axis));
    }
  }
  return [low, high];
}

function turnOf(wxyz: number[], out: THREE.Quaternion): THREE.Quaternion {
  return out.set(wxyz[1], wxyz[2], wxyz[3], wxyz[0]);
}

function planOf(run: Run, kind: Kind, joint: Joint): JointPlan {
  const ends = [joint.a, joint.b].filter((end) => end !== null);
  const bodies = [joint.body_a, joint.body_b].flatMap((b) => (b === null || kind.bodies[b].row === null ? [] : [kind.bodies[b]]));
  const radius = Math.min(...bodies.map((body) => body.radius));
  // In a series there are hinges about other axes at the same place, and bodies on one side alone.
  const most = ends.length < 2 ? SHORT : LONG;
  let [low, high] = [-most * radius, most * radius];
  for (const end of ends) {
    const body = end.body === null ? null : kind.bodies[end.body];
    if (body === null || body.row === null || body.shapes.length === 0) continue;
    const axis = new THREE.Vector3(0, 0, 1).applyQuaternion(turnOf(end.rotation, new THREE.Quaternion()));
    const extent = extentOf(run, body, new THREE.Vector3(...end.position), axis);
    low = Math.max(low, extent[0]);
    high = Math.min(high, extent[1]);
  }
  if (!Number.isFinite(radius)) return { joint, radius: 1, pin: [-0.5, 0.5] };
  return { joint, radius, pin: [low - POKE * radius, high + POKE * radius] };
}

export function hasJoints(runs: Run[]): boolean {
  return runs.some((run) => run.kinds.some((kind) => kind.joints.length > 0));
}

export class Joints {
  drawn = 0; // joints that were written last
  private readonly plans: JointPlan[][][]; // [run][kind]
  private readonly batches = new Map<UnitName, Batch>();
  // Of the joint that is being written.
  private readonly ends = [new THREE.Vector3(), new THREE.Vector3()];
  private readonly turns = [new THREE.Quaternion(), new THREE.Quaternion()];
  private readonly axis = new THREE.Vector3();
  private readonly turn = new THREE.Quaternion();
  private readonly down = new THREE.Vector3();
  private readonly origin = new THREE.Vector3(); // of the world
  private fade = 0;

  constructor(private readonly runs: Run[], private readonly coloring: Coloring, private readonly planar: boolean,
    private readonly room: Sides, look: Look, add: (batch: Batch) => void) {
    this.plans = runs.map((run) => run.kinds.map((kind) => kind.joints.map((joint) => planOf(run, kind, joint))));
    const capacity = new Map<UnitName, number>();
    for (const kind of runs.flatMap((run) => run.kinds)) {
      for (const joint of kind.joints) {
        for (const [name, pieces] of Object.entries(piecesOf(joint, planar)) as [UnitName, number][]) {
          capacity.set(name, (capacity.get(name) ?? 0) + pieces * kind.worlds);
        }
      }
    }
    const meshes = unitMeshes(planar);
    for (const [name, count] of capacity) {
      const { points, normals, triangles, lines } = meshes[name];
      const batch = new Batch(count);
      batch.addMesh(points, normals, triangles, look);
      if (lines.length > 0) batch.addLines(lines, 0.6);
      this.batches.set(name, batch);
      add(batch);
    }
  }

  // Instances that were written last.
  get pieces(): Pieces {
    return Object.fromEntries([...this.batches].map(([name, batch]) => [name, batch.count]));
  }

  private get metal(): Rgb {
    return this.coloring.tints.metal;
  }
  private get hemp(): Rgb {
    return this.coloring.tints.rope;
  }

  // All joints of a world that are there, as its bodies lie.
  write(cell: Cell, poses: Poses, fade: number): void {
    const kind = this.runs[cell.run].kinds[cell.kind];
    const plans = this.plans[cell.run][cell.kind];
    this.fade = fade;
    this.origin.set(cell.x, cell.y, 0);
    this.down.fromArray(kind.gravity);
    if (this.down.lengthSq() === 0) this.down.set(0, this.planar ? -1 : 0, this.planar ? 0 : -1);
    this.down.normalize();
    for (let j = 0; j < plans.length; ++j) {
      if (poses.joints[cell.world * plans.length + j] === 0) continue;
      const { joint } = plans[j];
      if (!this.place(kind, cell, poses, joint.a, 0) || !this.place(kind, cell, poses, joint.b, 1)) continue;
      ++this.drawn;
      this.draw(plans[j], cell);
    }
  }

  // Where an end is drawn; false: its body is not there.
  private place(kind: Kind, cell: Cell, poses: Poses, end: JointEnd | null, which: number): boolean {
    if (end === null) return true;
    const p = this.ends[which].fromArray(end.position);
    const q = turnOf(end.rotation, this.turns[which]);
    const body = end.body === null ? null : kind.bodies[end.body];
    if (body !== null && body.row === null) {
      turnOf(body.rotation, this.turn);
      p.applyQuaternion(this.turn).add(this.axis.fromArray(body.position));
      q.premultiply(this.turn);
    } else if (body !== null) {
      const item = cell.world * kind.rows + (body.row as number);
      if (poses.there[item] === 0) return false;
      this.turn.fromArray(poses.rotation, 4 * item);
      p.applyQuaternion(this.turn).add(this.axis.fromArray(poses.position, 3 * item));
      q.premultiply(this.turn);
    }
    p.x += cell.x;
    p.y += cell.y;
    if (this.planar) p.z = 0;
    return true;
  }

  private draw(plan: JointPlan, cell: Cell): void {
    const { joint, radius, pin } = plan;
    // Of a joint in a series between two bodies only the end that is on a body is known.
    if (joint.a === null && joint.b === null) return;
    const which = joint.a === null ? 1 : 0;
    const near = this.ends[which];
    const q = this.turns[which];
    const [a, b] = joint.a === null || joint.b === null ? [near, near] : this.ends;
    switch (joint.type) {
      case 'ball': this.put('ball', near, q, 1.3 * PIN * radius, 1.3 * PIN * radius, 1.3 * PIN * radius, this.metal); break;
      case 'fixed': this.put('block', near, q, PIN * radius, PIN * radius, PIN * radius, this.metal); break;
      case 'hinge': this.pin(near, q, radius, pin); break;
      case 'slider': this.rail(joint, near, q, b, radius); break;
      case 'wheel':
        this.pin(b, this.turns[joint.b === null ? 0 : 1], radius, pin);
        this.spring(a, b, 0.5 * SPRING * radius);
        break;
      case 'target':
        this.spring(a, b, 0.5 * SPRING * radius);
        this.put('ball', a, q, PIN * radius, PIN * radius, PIN * radius, this.metal);
        break;
      case 'pulley': this.pulley(joint, cell, a, b, radius); break;
      case 'distance': this.distance(joint, a, b, radius); break;
      default:
    }
  }

  private distance(joint: Joint, a: THREE.Vector3, b: THREE.Vector3, radius: number): void {
    const length = joint.length ?? 0;
    if (joint.form === 'spring') {
      this.spring(a, b, SPRING * radius);
    } else if (joint.form === 'rope') {
      polyline(ropePoints(a, b, length, this.down, ROPE_PIECES), (p, q) => this.bar(p, q, ROPE * radius, this.hemp));
    } else if (joint.form === 'telescope') {
      const middle = a.clone().lerp(b, 0.5);
      this.bar(a, middle, ROD * radius, this.metal);
      this.bar(middle, b, 0.55 * ROD * radius, this.metal);
    } else {
      this.bar(a, b, ROD * radius, this.metal);
      for (const end of [a, b]) this.put('ball', end, this.turns[0], 1.6 * ROD * radius, 1.6 * ROD * radius, 1.6 * ROD * radius, this.metal);
    }
  }

  // About z of a frame.
  private pin(at: THREE.Vector3, q: THREE.Quaternion, radius: number, [low, high]: [number, number]): void {
    if (this.planar) {
      this.put('ring', at, q, 1.2 * PIN * radius, 1.2 * PIN * radius, 1, this.metal);
      return;
    }
    this.axis.set(0, 0, low).applyQuaternion(q).add(at);
    this.put('bar', this.axis, q, PIN * radius, PIN * radius, high - low, this.metal);
  }

  // Along x of A's frame, as far as B goes on it.
  private rail(joint: Joint, at: THREE.Vector3, q: THREE.Quaternion, b: THREE.Vector3, radius: number): void {
    const along = this.axis.set(1, 0, 0).applyQuaternion(q).clone();
    const now = b.clone().sub(at).dot(along);
    const [low, high] = joint.range ?? [Math.min(0, now) - radius, Math.max(0, now) + radius];
    // Within the room of the world.
    const ends = [low, high].map((x) => at.clone().addScaledVector(along, x).sub(this.origin));
    const left = clipSegment(ends[0].toArray(), ends[1].toArray(), this.room);
    if (left !== null) {
      const [from, to] = left.map((end) => new THREE.Vector3(...end as [number, number, number]).add(this.origin));
      this.bar(from, to, 0.6 * ROD * radius, this.metal);
    }
    this.put('block', b, q, 1.5 * PIN * radius, PIN * radius, PIN * radius, this.metal);
  }

  private pulley(joint: Joint, cell: Cell, a: THREE.Vector3, b: THREE.Vector3, radius: number): void {
    const [over, other] = (joint.grounds ?? [[0, 0, 0], [0, 0, 0]]).map(([x, y, z]) => new THREE.Vector3(x + cell.x, y + cell.y, this.planar ? 0 : z));
    this.bar(a, over, ROPE * radius, this.hemp);
    this.bar(over, other, ROPE * radius, this.hemp);
    this.bar(other, b, ROPE * radius, this.hemp);
    // Wheels turn in the plane of the rope.
    const normal = other.clone().sub(over).cross(this.down);
    if (normal.lengthSq() < 1e-12) normal.set(0, 0, 1);
    this.turn.setFromUnitVectors(this.axis.set(0, 0, 1), normal.normalize());
    if (this.planar) this.turn.identity();
    for (const wheel of [over, other]) this.put('ring', wheel, this.turn, WHEEL * radius, WHEEL * radius, this.planar ? 1 : WHEEL * radius, this.metal);
  }

  private bar(from: THREE.Vector3, to: THREE.Vector3, radius: number, color: Rgb): void {
    this.stretch('bar', from, to, radius, color);
  }
  private spring(from: THREE.Vector3, to: THREE.Vector3, radius: number): void {
    this.stretch('spring', from, to, radius, this.metal);
  }

  private stretch(name: UnitName, from: THREE.Vector3, to: THREE.Vector3, radius: number, color: Rgb): void {
    const along = this.axis.copy(to).sub(from);
    const length = along.length();
    if (!(length > 1e-9)) return;
    along.divideScalar(length);
    if (this.planar) {
      const half = Math.atan2(along.y, along.x) / 2;
      this.put(name, from, this.turn.set(0, 0, Math.sin(half), Math.cos(half)), length, radius, 1, color);
    } else {
      this.put(name, from, this.turn.setFromUnitVectors(Z, along), radius, radius, length, color);
    }
  }

  private put(name: UnitName, at: THREE.Vector3, q: THREE.Quaternion, x: number, y: number, z: number, color: Rgb): void {
    const batch = this.batches.get(name)!;
    const out = batch.data;
    const o = STRIDE * batch.count++;
    out[o] = at.x; out[o + 1] = at.y; out[o + 2] = this.planar ? ABOVE : at.z;
    out[o + 3] = x; out[o + 4] = y; out[o + 5] = z;
    out[o + 6] = q.x; out[o + 7] = q.y; out[o + 8] = q.z; out[o + 9] = q.w;
    out[o + 10] = out[o + 11] = out[o + 12] = 0;
    put(color, out, o + 13);
    out[o + 16] = this.fade;
  }
}

const Z = new THREE.Vector3(0, 0, 1);
