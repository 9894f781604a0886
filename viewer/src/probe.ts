// The page for tests and for those who drive it from elsewhere: window.manyworlds.
import * as THREE from 'three';

import { boundsOf } from './bounds';
import type { App } from './main';

export class Probe {
  constructor(private readonly app: App) {}

  seek(time: number): void {
    this.app.timeline.seek(time);
  }

  // Without moving the camera, which a click does.
  choose(cell: number, row: number): void {
    this.app.choose(cell, row);
  }

  get report() {
    const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1] ?? 0;
    return {
      instances: this.app.worlds.instances,
      drawn: this.app.worlds.drawn,
      worlds: this.app.worlds.layout.cells.length,
      frames: this.app.sources.map((source) => source.frames),
      time: this.app.timeline.time,
      frame: this.app.worlds.frame,
      playing: this.app.timeline.playing,
      speed: this.app.timeline.speed,
      looping: this.app.timeline.looping,
      chosen: { ...this.app.chosen },
      following: this.app.following,
      still: this.app.worlds.still,
      cell: { width: this.app.worlds.layout.width, depth: this.app.worlds.layout.depth },
      contacts: this.app.overlays.contactsDrawn,
      joints: this.app.worlds.jointsDrawn,
      jointPieces: this.app.worlds.jointPieces,
      drawCalls: this.app.worlds.objects + this.app.overlays.objects,
      allCalls: this.app.stage.renderer.info.render.calls,
      triangles: this.app.stage.renderer.info.render.triangles,
      scriptMs: median(this.app.script),
      waiting: this.app.dirty,
      flying: this.app.stage.flying,
      live: this.app.live === null ? null : { ...this.app.live.state, dragging: this.app.grab?.dragging ?? false },
    };
  }

  // ms of script for each of so many frames, one after the other and without GL: reading frames,
  // writing instances, what is written beside the picture.
  async measure(frames: number): Promise<number[]> {
    const out: number[] = [];
    for (let i = 0; i < frames; ++i) {
      const time = (this.app.timeline.end * (i + 0.5)) / frames;
      await Promise.all(this.app.sources.map(async (source) => {
        for (let frame = 0; frame < source.frames; ++frame) await source.prepare(frame);
      }));
      const began = performance.now();
      this.app.timeline.time = time;
      this.app.worlds.read(time);
      this.app.worlds.widenScales();
      this.app.worlds.write(this.app.stage.camera, this.app.stage.pixelsPerMetre);
      this.app.overlays.update(this.app.chosen);
      this.app.tell(began);
      out.push(performance.now() - began);
    }
    this.app.redraw();
    return out;
  }

  // Draws so many frames, spread over the time.
  async drawFrames(frames: number): Promise<void> {
    for (let i = 0; i < frames; ++i) {
      const time = (this.app.timeline.end * (i + 0.5)) / frames;
      await this.app.prepare(time);
      await new Promise((resolve) => { requestAnimationFrame(resolve); });
      this.app.drawAt(time);
    }
  }

  bodyAt(cell: number, row: number) {
    const place = this.app.worlds.placeOf(cell, row, new THREE.Vector3());
    const one = this.app.worlds.layout.cells[cell];
    const poses = this.app.worlds.posesOf(one);
    const item = one.world * this.app.worlds.kindOf(one).rows + row;
    return {
      pixel: this.app.stage.pixelOf(place), color: this.app.worlds.colorOf(cell, row), force: poses.force[item],
      position: [...poses.position.subarray(3 * item, 3 * item + 3)],
      rotation: [...poses.rotation.subarray(4 * item, 4 * item + 4)],
      bounds: boundsOf(this.app.worlds, cell).get(row)?.getSize(new THREE.Vector3()).toArray() ?? [],
    };
  }

  // Where a place of a world is drawn.
  pixelOf(cell: number, place: number[]) {
    const { x, y } = this.app.worlds.layout.cells[cell];
    return this.app.stage.pixelOf(new THREE.Vector3(place[0] + x, place[1] + y, place[2] ?? 0));
  }

  jointsOf(cell: number) {
    return this.app.worlds.kindOf(this.app.worlds.layout.cells[cell]).joints;
  }

  // Of a world at the moment that is shown: bodies of the scene, point, normal, force in N.
  contactsAt(cell: number) {
    const one = this.app.worlds.layout.cells[cell];
    const out: { a: number; b: number; point: number[]; normal: number[]; force: number }[] = [];
    this.app.sources[one.run].visitContacts(this.app.worlds.frameOf(one), one.kind, one.world,
      (a, b, x, y, z, nx, ny, nz, force) => out.push({ a, b, point: [x, y, z], normal: [nx, ny, nz], force }));
    return out;
  }

  // What is drawn at a place of the canvas: red, green, blue.
  pixelAt(x: number, y: number): number[] {
    this.app.draw(performance.now());
    const { renderer } = this.app.stage;
    const gl = renderer.getContext();
    const ratio = renderer.getPixelRatio();
    const out = new Uint8Array(4);
    gl.readPixels(Math.round(x * ratio), Math.round(gl.drawingBufferHeight - y * ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return [...out.subarray(0, 3)];
  }
}
