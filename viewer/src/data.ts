// What the page shows: heads of recordings, and frames of them.
//
// A FrameSource is all that most of the page knows of where frames come from: recordings inside the page
// (recorded.ts), or a socket that delivers frames of a running batch (live.ts), whose `frames` grows.

import type { VisitContact } from './contacts';

export interface MeshLevel {
  points: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  lines: Float32Array; // pairs of points
  marks: Float32Array;
}

export interface Mesh {
  kind: string;
  levels: MeshLevel[]; // the finest first
}

export interface Shape {
  shape: number; // among all shapes of the scene
  mesh: number;
  size: number[];
  stretch: number[];
  position: number[];
  rotation: number[]; // w x y z
}

export interface Body {
  name: string;
  motion: 'dynamic' | 'kinematic' | 'fixed';
  row: number | null;
  radius: number; // m
  position: number[];
  rotation: number[];
  center: number[]; // of mass, body frame
  mass: number; // kg
  shapes: Shape[];
}

export interface JointEnd {
  body: number | null;
  position: number[];
  rotation: number[];
}

export interface Joint {
  name: string;
  type: string;
  body_a: number | null; // null: the world
  body_b: number | null;
  a: JointEnd | null; // null: within a series of joints, on no body
  b: JointEnd | null;
  form?: 'rod' | 'rope' | 'spring' | 'telescope'; // of distance joints
  length?: number; // m, of a rod, a rope or a spring at rest
  range?: [number, number] | null; // m, of sliders and wheels; null: without end
  grounds?: [number[], number[]]; // m, in the world: wheels of a pulley
}

export interface Kind {
  scene: string;
  gravity: number[];
  rows: number; // moving bodies
  low: number[];
  high: number[];
  bodies: Body[];
  joints: Joint[];
  first_world: number;
  worlds: number;
  names: number[];
  orientation: 0 | 2 | 4;
  turns: boolean; // orientations are simulated; where not, bodies are drawn without turning
  sizes: { shape: number; values: Float32Array }[]; // [world] size x y z, stretch x y z
  contact_step?: number; // m, of points of contacts
  controls?: { name: string; low: number; high: number; value: number }[]; // of a live page
}

export interface WorldNumber {
  name: string;
  unit: string;
  values: Float32Array; // [frame][world]
}

export interface Run {
  origin: string;
  space: 'planar' | 'spatial';
  dt: number;
  slowest: number; // m/s or rad/s
  speed_steps: number;
  meshes: Mesh[];
  kinds: Kind[];
  numbers: WorldNumber[];
  contacts?: boolean; // whether they were recorded
}

// The moving bodies of a kind at one moment, [world][row].
export interface Poses {
  position: Float32Array; // x y z
  rotation: Float32Array; // x y z w
  speed: Uint8Array; // coded
  spin: Uint8Array;
  there: Uint8Array; // 0: disabled
  status: Int32Array; // [world]
  force: Float32Array; // N, sum of what contacts press with; 0 where nobody asked
  joints: Uint8Array; // [world][joint]; 0: disabled or broken
}

export interface FrameSource {
  readonly run: Run;
  readonly frames: number;
  time(frame: number): number; // s
  // Whether poses of the frame can be read at once; prepare() sees to that it will be so.
  ready(frame: number): boolean;
  prepare(frame: number): Promise<void>;
  // Poses between a frame and the next one, 0 <= part < 1. Both must be ready.
  read(frame: number, part: number, kind: number, into: Poses): void;
  // Contacts of a world at a frame; none where that is not ready, or they were not recorded.
  visitContacts(frame: number, kind: number, world: number, visit: VisitContact): void;
  // Where one body, world * rows + row, is at a frame; false where that is not ready.
  positionAt(frame: number, kind: number, item: number, out: number[]): boolean;
}

export function emptyPoses(kind: Kind): Poses {
  const items = kind.worlds * kind.rows;
  return {
    position: new Float32Array(3 * items),
    rotation: new Float32Array(4 * items),
    speed: new Uint8Array(items),
    spin: new Uint8Array(items),
    there: new Uint8Array(items).fill(1),
    status: new Int32Array(kind.worlds),
    force: new Float32Array(items),
    joints: new Uint8Array(kind.worlds * kind.joints.length).fill(1),
  };
}

// Bits of a world's status (results.hpp).
export const LOST = 1 | 2 | 4;

export function speedOf(run: Run, code: number): number {
  return code === 0 ? 0 : run.slowest * 2 ** ((code - 1) / run.speed_steps);
}
