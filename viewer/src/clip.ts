// Cuts what does not move at the sides of a world's tile, so that it does not run into its neighbours.

// In x and y, m, about the origin of a world.
export interface Sides {
  low: number[];
  high: number[];
}

// x y z, and whatever goes along with it in a straight line, such as a normal.
type Vertex = number[];

// How far inside of one of the four sides.
function inside(v: Vertex, sides: Sides, side: number): number {
  const c = side >> 1;
  return side & 1 ? sides.high[c] - v[c] : v[c] - sides.low[c];
}

function between(a: Vertex, b: Vertex, part: number): Vertex {
  return a.map((x, c) => x + part * (b[c] - x));
}

export function isInside(v: Vertex, sides: Sides): boolean {
  return [0, 1, 2, 3].every((side) => inside(v, sides, side) >= 0);
}

// What is left of a convex polygon; empty where nothing is.
export function clipPolygon(polygon: Vertex[], sides: Sides): Vertex[] {
  let left = polygon;
  for (let side = 0; side < 4; ++side) {
    const out: Vertex[] = [];
    left.forEach((b, i) => {
      const a = left[(i + left.length - 1) % left.length];
      const [fromA, fromB] = [inside(a, sides, side), inside(b, sides, side)];
      if ((fromA < 0) !== (fromB < 0)) out.push(between(a, b, fromA / (fromA - fromB)));
      if (fromB >= 0) out.push(b);
    });
    left = out;
  }
  return left;
}

// What is left of a segment, or null.
export function clipSegment(a: Vertex, b: Vertex, sides: Sides): [Vertex, Vertex] | null {
  let [begin, end] = [0, 1];
  for (let side = 0; side < 4; ++side) {
    const [fromA, fromB] = [inside(a, sides, side), inside(b, sides, side)];
    if (fromA < 0 && fromB < 0) return null;
    if (fromA < 0) begin = Math.max(begin, fromA / (fromA - fromB));
    else if (fromB < 0) end = Math.min(end, fromA / (fromA - fromB));
  }
  return begin < end ? [between(a, b, begin), between(a, b, end)] : null;
}
