// Camera, light and the way around.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { setBackground } from './batches';
import type { Theme } from './coloring';

export interface Box {
  low: number[];
  high: number[];
}

interface Flight {
  from: { target: THREE.Vector3; eye: THREE.Vector3; zoom: number };
  to: { target: THREE.Vector3; eye: THREE.Vector3; zoom: number };
  began: number;
}

const FLIGHT_MS = 550;
const FIELD_OF_VIEW = 32;

export const THEMES: Record<'light' | 'dark', Theme & { sky: string; skyTop: string }> = {
  light: {
    sky: '#e9edf3', skyTop: '#ffffff', ground: '#e3e8f0', wall: '#8ea3c4', tile: '#fbfbf9', lost: '#e59a94',
    selected: '#b9cdf3', fixed: '#97a3b6', metal: '#4d5768', rope: '#7a5c34',
  },
  dark: {
    sky: '#12151c', skyTop: '#0d1016', ground: '#4b5568', wall: '#7d93bb', tile: '#222835', lost: '#7c3430',
    selected: '#4a6bb0', fixed: '#66738a', metal: '#b4bfd2', rope: '#d3b27c',
  },
};

export class Stage {
  readonly renderer: THREE.WebGLRenderer;
  readonly scene = new THREE.Scene();
  readonly controls: OrbitControls;
  camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  private readonly sun = new THREE.DirectionalLight('#fffaf2', 2.2);
  private readonly sky = new THREE.HemisphereLight('#ffffff', '#aab2c2', 2.0);
  private flight: Flight | null = null;
  private size = { width: 1, height: 1 };
  private extent = 1; // m, of what is shown
  insets = { top: 0, right: 0, bottom: 0, left: 0 }; // pixels that panels cover

  constructor(canvas: HTMLCanvasElement, readonly planar: boolean) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.shadowMap.enabled = !planar;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.toneMapping = planar ? THREE.NoToneMapping : THREE.NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.0;
    this.camera = planar
      ? new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 1000)
      : new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.1, 1000);
    this.camera.up.set(0, planar ? 1 : 0, planar ? 0 : 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableRotate = !planar;
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = planar;
    this.controls.enableDamping = false;
    if (!planar) this.controls.maxPolarAngle = 0.495 * Math.PI; // stay above the ground
    if (planar) {
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.intensity = 0.72;
    this.scene.add(this.sun, this.sun.target, this.sky);
  }

  // Whether there is no graphics card behind it, so that every triangle counts.
  get software(): boolean {
    const gl = this.renderer.getContext();
    const about = gl.getExtension('WEBGL_debug_renderer_info');
    const name = String(gl.getParameter(about === null ? gl.RENDERER : about.UNMASKED_RENDERER_WEBGL));
    return /swiftshader|llvmpipe|software/i.test(name);
  }

  setTheme(name: 'light' | 'dark'): void {
    this.scene.background = new THREE.Color(THEMES[name].sky);
    setBackground(THEMES[name].sky);
    this.sky.intensity = name === 'dark' ? 1.3 : 2.0;
    this.sky.groundColor.set(name === 'dark' ? '#5a6376' : '#b9c2d3');
    this.sun.intensity = name === 'dark' ? 1.9 : 2.2;
  }

  set shadows(on: boolean) {
    this.sun.castShadow = on && !this.planar;
  }

  resize(width: number, height: number): void {
    this.size = { width, height };
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.project();
  }

  private project(): void {
    const { width, height } = this.size;
    const aspect = width / Math.max(1, height);
    const { camera } = this;
    if (camera instanceof THREE.PerspectiveCamera) {
      camera.aspect = aspect;
      const away = camera.position.distanceTo(this.controls.target);
      camera.near = Math.max(away / 400, 1e-4);
      camera.far = away + 6 * this.extent;
    } else {
      camera.left = -aspect;
      camera.right = aspect;
      camera.near = 0.1;
      camera.far = 1000;
    }
    camera.updateProjectionMatrix();
  }

  // Pixels per m: in the plane everywhere, in space at a distance of 1 m.
  get pixelsPerMetre(): number {
    const { camera } = this;
    if (camera instanceof THREE.OrthographicCamera) return (this.size.height / 2) * camera.zoom;
    return this.size.height / (2 * Math.tan((Math.PI / 360) * FIELD_OF_VIEW));
  }

  // Where to stand so that a box fills what panels leave free.
  private standFor(box: Box, keepDirection: boolean, elevation: number, yaw: number) {
    const low = new THREE.Vector3(...box.low);
    const high = new THREE.Vector3(...box.high);
    const target = low.clone().add(high).multiplyScalar(0.5);
    const { width, height } = this.size;
    const free = {
      width: Math.max(60, width - this.insets.left - this.insets.right),
      height: Math.max(60, height - this.insets.top - this.insets.bottom),
    };
    const shift = {
      x: (this.insets.left - this.insets.right) / 2 / (height / 2),
      y: (this.insets.bottom - this.insets.top) / 2 / (height / 2),
    };
    if (this.planar) {
      const zoom = 0.94 * Math.min(
        (2 * free.width) / height / Math.max(1e-9, high.x - low.x), (2 * free.height) / height / Math.max(1e-9, high.y - low.y));
      target.z = 0;
      target.x -= shift.x / zoom;
      target.y -= shift.y / zoom;
      return { target, eye: new THREE.Vector3(target.x, target.y, 100), zoom };
    }
    const direction = keepDirection
      ? this.camera.position.clone().sub(this.controls.target).normalize()
      : new THREE.Vector3(-yaw * Math.cos(elevation), -Math.cos(elevation), Math.sin(elevation)).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(direction).normalize();
    const up = direction.clone().cross(right);
    const tangent = Math.tan((Math.PI / 360) * FIELD_OF_VIEW);
    const corners = Array.from({ length: 8 }, (_, i) =>
      new THREE.Vector3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z));
    const from = new THREE.Vector3();
    let away = high.distanceTo(low) / tangent;
    // What is near looks larger, so the middle of the box is not that of its picture: a few rounds
    // of looking where its corners come to lie.
    for (let round = 0; round < 30; ++round) {
      let [left, right1, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
      for (const corner of corners) {
        from.copy(corner).sub(target);
        const deep = Math.max(away - from.dot(direction), 0.05 * away);
        const u = from.dot(right) / deep / tangent;
        const v = from.dot(up) / deep / tangent;
        left = Math.min(left, u);
        right1 = Math.max(right1, u);
        bottom = Math.min(bottom, v);
        top = Math.max(top, v);
      }
      target.addScaledVector(right, (0.5 * (left + right1) - shift.x) * away * tangent);
      target.addScaledVector(up, (0.5 * (bottom + top) - shift.y) * away * tangent);
      const fill = 0.5 * Math.max((right1 - left) * (height / free.width), (top - bottom) * (height / free.height));
      away *= 1 + 0.6 * (fill - 0.97);
    }
    return { target, eye: target.clone().addScaledVector(direction, away), zoom: 1 };
  }

  show(box: Box, options: { fly: boolean; keepDirection?: boolean; elevation?: number; yaw?: number }): void {
    const to = this.standFor(box, options.keepDirection ?? false, options.elevation ?? 0.72, options.yaw ?? 0.38);
    this.extent = Math.max(...[0, 1, 2].map((c) => box.high[c] - box.low[c]), this.extent);
    if (!options.fly) {
      this.flight = null;
      this.stand(to);
      return;
    }
    this.flight = {
      from: { target: this.controls.target.clone(), eye: this.camera.position.clone(), zoom: this.camera.zoom },
      to, began: performance.now(),
    };
  }

  private stand(at: { target: THREE.Vector3; eye: THREE.Vector3; zoom: number }): void {
    this.controls.target.copy(at.target);
    this.camera.position.copy(at.eye);
    this.camera.zoom = at.zoom;
    this.controls.update();
    this.project();
  }

  // Moves with a body.
  shift(by: THREE.Vector3): void {
    this.controls.target.add(by);
    this.camera.position.add(by);
    if (this.flight !== null) {
      for (const end of [this.flight.from, this.flight.to]) {
        end.target.add(by);
        end.eye.add(by);
      }
    }
  }

  get flying(): boolean {
    return this.flight !== null;
  }

  // One step of a flight.
  advance(now: number): void {
    if (this.flight === null) return;
    const part = Math.min(1, (now - this.flight.began) / FLIGHT_MS);
    const s = part * part * (3 - 2 * part);
    const { from, to } = this.flight;
    this.stand({
      target: from.target.clone().lerp(to.target, s),
      eye: from.eye.clone().lerp(to.eye, s),
      zoom: from.zoom * (to.zoom / from.zoom) ** s,
    });
    if (part === 1) this.flight = null;
  }

  endFlight(): void {
    if (this.flight === null) return;
    this.stand(this.flight.to);
    this.flight = null;
  }

  ray(x: number, y: number): THREE.Ray {
    const caster = new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(new THREE.Vector2((2 * x) / this.size.width - 1, 1 - (2 * y) / this.size.height), this.camera);
    return caster.ray;
  }

  pixelOf(point: THREE.Vector3): { x: number; y: number } {
    this.camera.updateMatrixWorld();
    const p = point.clone().project(this.camera);
    return { x: ((p.x + 1) / 2) * this.size.width, y: ((1 - p.y) / 2) * this.size.height };
  }

  // cell: m, size of a world; all: m, of everything.
  render(cell: number, all: number): void {
    this.project();
    if (!this.planar && this.sun.castShadow) {
      const away = this.camera.position.distanceTo(this.controls.target);
      const reach = Math.min(0.75 * all, Math.max(0.9 * cell, 0.55 * away));
      // In whole texels, so that shadows stand still when the camera moves.
      const texel = (2 * reach) / this.sun.shadow.mapSize.x;
      const at = this.controls.target;
      this.sun.target.position.set(Math.round(at.x / texel) * texel, Math.round(at.y / texel) * texel, Math.round(at.z / texel) * texel);
      this.sun.position.copy(this.sun.target.position).addScaledVector(SUN, 2.5 * reach + 2 * cell);
      const lens = this.sun.shadow.camera;
      lens.left = lens.bottom = -reach;
      lens.right = lens.top = reach;
      lens.near = 0.01 * reach;
      lens.far = 5 * reach + 4 * cell;
      lens.updateProjectionMatrix();
      this.sun.shadow.normalBias = 1.5 * texel;
      this.sun.shadow.bias = -0.0004;
      this.sun.shadow.radius = 2.5;
      this.sun.target.updateMatrixWorld();
    } else if (!this.planar) {
      this.sun.target.position.copy(this.controls.target);
      this.sun.position.copy(this.controls.target).addScaledVector(SUN, 10);
      this.sun.target.updateMatrixWorld();
    }
    this.renderer.render(this.scene, this.camera);
  }
}

const SUN = new THREE.Vector3(-0.55, -0.45, 1.0).normalize();
