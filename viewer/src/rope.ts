// Ropes: straight where they are taut, hanging in an arc of their length where they are slack.
import type { Vector3 } from 'three';

const ROUNDS = 24; // of halving

// A point of the arc whose middle hangs `sag` below the straight line.
function onArc(a: Vector3, b: Vector3, down: Vector3, sag: number, t: number, out: Vector3): Vector3 {
  return out.copy(a).lerp(b, t).addScaledVector(down, 4 * t * (1 - t) * sag);
}

function lengthOf(a: Vector3, b: Vector3, down: Vector3, sag: number, pieces: number): number {
  const [p, q] = [a.clone(), a.clone()];
  let out = 0;
  for (let i = 1; i <= pieces; ++i) {
    onArc(a, b, down, sag, i / pieces, q);
    out += p.distanceTo(q);
    p.copy(q);
  }
  return out;
}

// Corners of a rope of a length from a to b, as many pieces or, taut, one.
export function ropePoints(a: Vector3, b: Vector3, length: number, down: Vector3, pieces: number): Vector3[] {
  if (a.distanceTo(b) >= 0.999 * length) return [a.clone(), b.clone()];
  // The arc's length grows with its sag, which is at most half of it.
  let [low, high] = [0, length];
  for (let round = 0; round < ROUNDS; ++round) {
    const middle = (low + high) / 2;
    if (lengthOf(a, b, down, middle, pieces) < length) low = middle;
    else high = middle;
  }
  return Array.from({ length: pieces + 1 }, (_, i) => onArc(a, b, down, low, i / pieces, a.clone()));
}

export function polyline(points: Vector3[], visit: (from: Vector3, to: Vector3) => void): void {
  for (let i = 0; i + 1 < points.length; ++i) visit(points[i], points[i + 1]);
}
