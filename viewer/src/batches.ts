// Draws instances of meshes: one call for each mesh and level of detail, however many worlds.
//
// An instance is 17 numbers: position, size, rotation x y z w, stretch, colour, fade. A point p of the mesh
// is at position + rotation (size p + stretch sign(p)). Fade is 0 to 1, how far colours are those of the background.
import * as THREE from 'three';

import { srgb } from './colors';

const STRIDE = 17;

const background = { value: new THREE.Vector3(1, 1, 1) }; // sRGB, as the pixels have it

export function setBackground(hex: string): void {
  background.value.fromArray(srgb(hex));
}

const PLACE = `
attribute vec3 iPosition;
attribute vec3 iSize;
attribute vec4 iRotation;
attribute vec3 iStretch;
attribute vec3 iColor;
attribute float iFade;
varying vec3 vTint;
varying float vFade;
vec3 turned(vec3 v) {
  return v + 2.0 * cross(iRotation.xyz, cross(iRotation.xyz, v) + iRotation.w * v);
}
vec3 placed(vec3 p) { return iPosition + turned(iSize * p + iStretch * sign(p)); }
`;

function withInstances<M extends THREE.Material>(material: M, shade = 1): M {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = PLACE + shader.vertexShader
      .replace('#include <beginnormal_vertex>', 'vec3 objectNormal = turned(normal / iSize);')
      .replace('#include <begin_vertex>', 'vec3 transformed = placed(position); vTint = iColor; vFade = iFade;');
    shader.uniforms.background = background;
    shader.fragmentShader = 'varying vec3 vTint;\nvarying float vFade;\nuniform vec3 background;\n' + shader.fragmentShader
      .replace('#include <color_fragment>', `diffuseColor.rgb *= ${shade.toFixed(3)} * vTint;`)
      // After light and tone, so that what is faded has one look in every theme.
      .replace('#include <fog_fragment>', 'gl_FragColor.rgb = mix(gl_FragColor.rgb, background, vFade);');
  };
  material.customProgramCacheKey = () => `instances-${material.type}-${shade}`;
  return material;
}

export interface Look {
  lit: boolean; // shaded; else plain colour
  opacity: number;
  wireframe: boolean;
  shadows: boolean;
}

export function makeMaterial(look: Look): THREE.Material {
  const common = {
    transparent: look.opacity < 1, opacity: look.opacity, depthWrite: look.opacity === 1,
    wireframe: look.wireframe, side: THREE.FrontSide,
  };
  return withInstances(look.lit
    ? new THREE.MeshStandardMaterial({ ...common, roughness: 0.62, metalness: 0.02 })
    : new THREE.MeshBasicMaterial(common));
}

export function lineMaterial(opacity: number): THREE.Material {
  return withInstances(new THREE.LineBasicMaterial({ transparent: true, opacity, depthWrite: false }), 0.25);
}

const shadowMaterial = withInstances(
  new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking }));

// Instances of one mesh at one level.
export class Batch {
  data: Float32Array;
  count = 0;
  readonly objects: THREE.Object3D[] = [];
  private readonly geometries: THREE.InstancedBufferGeometry[] = [];
  private buffer: THREE.InstancedInterleavedBuffer;

  constructor(capacity: number) {
    this.data = new Float32Array(STRIDE * Math.max(1, capacity));
    this.buffer = new THREE.InstancedInterleavedBuffer(this.data, STRIDE, 1);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
  }

  private geometry(points: Float32Array): THREE.InstancedBufferGeometry {
    const out = new THREE.InstancedBufferGeometry();
    out.setAttribute('position', new THREE.BufferAttribute(points, 3));
    const part = (name: string, size: number, at: number) =>
      out.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, size, at));
    part('iPosition', 3, 0);
    part('iSize', 3, 3);
    part('iRotation', 4, 6);
    part('iStretch', 3, 10);
    part('iColor', 3, 13);
    part('iFade', 1, 16);
    this.geometries.push(out);
    return out;
  }

  addMesh(points: Float32Array, normals: Float32Array, triangles: Uint32Array, look: Look): THREE.Mesh {
    const geometry = this.geometry(points);
    geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    const mesh = new THREE.Mesh(geometry, makeMaterial(look));
    mesh.frustumCulled = false;
    mesh.castShadow = look.shadows && look.opacity === 1;
    mesh.receiveShadow = look.lit;
    mesh.customDepthMaterial = shadowMaterial;
    this.objects.push(mesh);
    return mesh;
  }

  addLines(points: Float32Array, opacity: number): THREE.LineSegments {
    const lines = new THREE.LineSegments(this.geometry(points), lineMaterial(opacity));
    lines.frustumCulled = false;
    lines.renderOrder = 2;
    this.objects.push(lines);
    return lines;
  }

  // What was written to data[0 .. count * STRIDE) is drawn from now on.
  finish(): void {
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, this.count * STRIDE);
    this.buffer.needsUpdate = true;
    for (const geometry of this.geometries) geometry.instanceCount = this.count;
    for (const object of this.objects) object.visible = object.userData.shown !== false && this.count > 0;
  }
}

export { STRIDE };
