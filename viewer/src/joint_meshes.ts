// Meshes of which joints are drawn, of unit size: instances stretch them.
import * as THREE from 'three';

export interface UnitMesh {
  points: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  lines: Float32Array; // pairs of points: what is thinner than a pixel is seen none the less
}

export type UnitName = 'bar' | 'ball' | 'ring' | 'spring' | 'block';

const COILS = 8;

function unit(geometry: THREE.BufferGeometry, lines: number[] = []): UnitMesh {
  const index = geometry.getIndex();
  const points = geometry.getAttribute('position').array as Float32Array;
  const triangles = index === null ? Uint32Array.from({ length: points.length / 3 }, (_, i) => i) : new Uint32Array(index.array);
  const normals = geometry.getAttribute('normal').array as Float32Array;
  geometry.dispose();
  return { points: new Float32Array(points), normals: new Float32Array(normals), triangles, lines: new Float32Array(lines) };
}

// A zigzag from x = 0 to 1 whose strokes have some width.
function zigzag(): THREE.BufferGeometry {
  const half = 0.012;
  const corners = [[0, 0], [0.08, 0], ...Array.from({ length: 2 * COILS }, (_, i) => [0.1 + (0.8 * (i + 0.5)) / (2 * COILS), i % 2 === 0 ? 1 : -1]), [0.92, 0], [1, 0]];
  const points: number[] = [];
  for (let i = 0; i + 1 < corners.length; ++i) {
    const [[x0, y0], [x1, y1]] = [corners[i], corners[i + 1]];
    const [dx, dy] = y0 === y1 ? [0, 0.15] : [half, 0];
    const [a, b, c, d] = [[x0 - dx, y0 - dy], [x0 + dx, y0 + dy], [x1 + dx, y1 + dy], [x1 - dx, y1 - dy]];
    // Seen from in front, whichever way the stroke goes.
    const quad = [a, b, c, a, c, d];
    const turned = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0 ? [a, c, b, a, d, c] : quad;
    for (const [x, y] of turned) points.push(x, y, 0);
  }
  const out = new THREE.BufferGeometry();
  out.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  out.setAttribute('normal', new THREE.Float32BufferAttribute(points.map((_, i) => (i % 3 === 2 ? 1 : 0)), 3));
  return out;
}

class Helix extends THREE.Curve<THREE.Vector3> {
  constructor() {
    super();
  }
  override getPoint(t: number, out = new THREE.Vector3()): THREE.Vector3 {
    const wide = Math.min(1, 12 * t, 12 * (1 - t)); // its ends are on the axis
    const angle = 2 * Math.PI * COILS * t;
    return out.set(wide * Math.cos(angle), wide * Math.sin(angle), COILS * t);
  }
}

// In the plane bars and springs go along x, in space along z, from 0 to 1; rings are about z.
export function unitMeshes(planar: boolean): Record<UnitName, UnitMesh> {
  if (planar) {
    return {
      bar: unit(new THREE.PlaneGeometry(1, 2).translate(0.5, 0, 0), [0, 0, 0, 1, 0, 0]),
      ball: unit(new THREE.CircleGeometry(1, 20)),
      ring: unit(new THREE.RingGeometry(0.5, 1, 24)),
      spring: unit(zigzag(), [0, 0, 0, 0.1, 0, 0, 0.9, 0, 0, 1, 0, 0]),
      block: unit(new THREE.PlaneGeometry(2, 2)),
    };
  }
  return {
    bar: unit(new THREE.CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5), [0, 0, 0, 0, 0, 1]),
    ball: unit(new THREE.SphereGeometry(1, 16, 10)),
    ring: unit(new THREE.TorusGeometry(0.8, 0.2, 8, 24)),
    spring: unit(new THREE.TubeGeometry(new Helix(), 20 * COILS, 0.16, 5).scale(1, 1, 1 / COILS)),
    block: unit(new THREE.BoxGeometry(2, 2, 2)),
  };
}
