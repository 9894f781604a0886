// Bodies in the hand: a drag pulls the point that was grabbed towards the cursor, in the plane through it that
// faces the camera; a click with shift pushes.
import * as THREE from 'three';

import type { App } from './main';
import type { LiveSource } from './live';
import { pickBody, type Hit } from './pick';

const BEGINS_PIXELS = 3; // less is a click

interface Grabbed {
  hit: Hit;
  world: number;
  body: number;
  at: THREE.Vector3; // body frame
  plane: THREE.Plane;
  moved: boolean;
  x: number;
  y: number;
}

export class Grab {
  pushSpeed = 3; // m/s
  private held: Grabbed | null = null;

  constructor(private readonly app: App, private readonly source: LiveSource, canvas: HTMLCanvasElement) {
    // Before the camera's own listeners.
    canvas.addEventListener('pointerdown', (event) => this.down(event, canvas), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event.clientX, event.clientY));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(end, () => this.drop());
    }
  }

  get dragging(): boolean {
    return this.held?.moved ?? false;
  }

  private down(event: PointerEvent, canvas: HTMLCanvasElement): void {
    if (event.button !== 0 || event.ctrlKey || event.metaKey || event.altKey || !event.isPrimary) return;
    const ray = this.app.stage.ray(event.clientX, event.clientY);
    const hit = pickBody(this.app.worlds, ray);
    if (hit === null) return;
    const { worlds, stage } = this.app;
    const cell = worlds.layout.cells[hit.cell];
    const kind = worlds.kindOf(cell);
    const body = kind.bodies.findIndex((one) => one.row === hit.row);
    if (kind.bodies[body].motion !== 'dynamic') return;
    const turn = new THREE.Quaternion().fromArray(worlds.posesOf(cell).rotation, 4 * (cell.world * kind.rows + hit.row));
    const at = hit.point.clone();
    if (worlds.planar) at.z = 0;
    at.sub(worlds.placeOf(hit.cell, hit.row, new THREE.Vector3())).applyQuaternion(turn.invert());
    const world = kind.first_world + cell.world;
    if (event.shiftKey) {
      const impulse = ray.direction.clone();
      if (worlds.planar) impulse.copy(worlds.placeOf(hit.cell, hit.row, new THREE.Vector3())).sub(hit.point).setZ(0);
      if (impulse.lengthSq() === 0) impulse.set(1, 0, 0);
      impulse.normalize().multiplyScalar(this.pushSpeed * kind.bodies[body].mass);
      this.source.link.send({ do: 'push', world, body, at: at.toArray(), impulse: impulse.toArray() });
      this.app.choose(hit.cell, hit.row);
      event.stopImmediatePropagation(); // no click, no turn of the camera
      return;
    }
    const facing = stage.camera.getWorldDirection(new THREE.Vector3());
    this.held = {
      hit, world, body, at, moved: false, x: event.clientX, y: event.clientY,
      plane: new THREE.Plane().setFromNormalAndCoplanarPoint(facing, hit.point),
    };
    stage.controls.enabled = false;
    canvas.setPointerCapture(event.pointerId);
  }

  private move(x: number, y: number): void {
    const { held } = this;
    if (held === null) return;
    if (!held.moved && Math.hypot(x - held.x, y - held.y) < BEGINS_PIXELS) return;
    held.moved = true;
    held.x = x;
    held.y = y;
    const to = this.app.stage.ray(x, y).intersectPlane(held.plane, new THREE.Vector3());
    if (to === null) return;
    held.hit.point.copy(to);
    const cell = this.app.worlds.layout.cells[held.hit.cell];
    const target = [to.x - cell.x, to.y - cell.y, this.app.worlds.planar ? 0 : to.z];
    this.source.link.later('drag', { do: 'drag', world: held.world, body: held.body, at: held.at.toArray(), to: target });
    this.app.redraw();
  }

  private drop(): void {
    if (this.held === null) return;
    if (this.held.moved) this.source.link.send({ do: 'drop' });
    this.held = null;
    this.app.stage.controls.enabled = true;
    this.app.redraw();
  }

  // The spring, as it is drawn.
  line(): { from: THREE.Vector3; to: THREE.Vector3 } | null {
    if (this.held === null || !this.held.moved) return null;
    const { hit, at } = this.held;
    const cell = this.app.worlds.layout.cells[hit.cell];
    const kind = this.app.worlds.kindOf(cell);
    const turn = new THREE.Quaternion().fromArray(this.app.worlds.posesOf(cell).rotation, 4 * (cell.world * kind.rows + hit.row));
    const from = at.clone().applyQuaternion(turn).add(this.app.worlds.placeOf(hit.cell, hit.row, new THREE.Vector3()));
    return { from, to: hit.point.clone() };
  }
}
