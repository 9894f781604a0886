// The socket of a page that is live: messages to the program, and what it answers. How frames lie in bytes is
// in src/live/capture.hpp.

export interface LiveFrame {
  paused: boolean;
  time: number; // s
  steps: number;
  speed: number; // asked for, simulated per real second; infinite: as fast as it goes
  reached: number;
  lost: number; // of all worlds
  worlds: Uint32Array;
  status: Uint32Array;
  positions: Float32Array;
  turns: Int16Array;
  speeds: Uint8Array;
  spins: Uint8Array;
  there: Uint8Array;
  joints: Uint8Array; // of all worlds, those of one after those of the other
}

export interface Sized {
  shape: number;
  values: string; // base64 of float32
}

type Listener = {
  frame: (frame: LiveFrame) => void;
  said: (text: string) => void;
  sizes: (kinds: Sized[][]) => void;
  gone: (why: string) => void;
};

const MAGIC = 0x316c776d;
const HEAD = 64;
export const TURN_STEPS = 32767;

export function frameOf(bytes: ArrayBuffer, planar: boolean, turned: boolean): LiveFrame {
  const head = new DataView(bytes);
  if (bytes.byteLength < HEAD || head.getUint32(0, true) !== MAGIC) throw new Error('a frame is none');
  const worlds = head.getUint32(44, true);
  const bodies = head.getUint32(48, true);
  const joints = head.getUint32(52, true);
  const width = planar ? 2 : 3;
  const components = turned ? (planar ? 2 : 4) : 0;
  let at = HEAD;
  const next = (size: number) => {
    const from = at;
    at += size;
    return from;
  };
  return {
    paused: (head.getUint32(4, true) & 1) !== 0,
    time: head.getFloat64(8, true),
    steps: head.getFloat64(16, true),
    speed: head.getFloat64(24, true),
    reached: head.getFloat64(32, true),
    lost: head.getUint32(40, true),
    worlds: new Uint32Array(bytes, next(4 * worlds), worlds),
    status: new Uint32Array(bytes, next(4 * worlds), worlds),
    positions: new Float32Array(bytes, next(4 * width * bodies), width * bodies),
    turns: new Int16Array(bytes, next(2 * components * bodies), components * bodies),
    speeds: new Uint8Array(bytes, next(bodies), bodies),
    spins: new Uint8Array(bytes, next(bodies), bodies),
    there: new Uint8Array(bytes, next(bodies), bodies),
    joints: new Uint8Array(bytes, next(joints), joints),
  };
}

export class Link {
  listener: Listener | null = null;
  planar = false;
  turned = true;
  private readonly pending = new Map<string, object>(); // of which the last alone counts
  private head: ((head: unknown) => void) | null = null;

  private constructor(private readonly socket: WebSocket) {
    socket.binaryType = 'arraybuffer';
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => this.received(event.data);
    socket.onclose = (event) => {
      this.listener?.gone(event.reason || 'The program that stepped the worlds has ended.');
    };
  }

  // To the program that the page came from.
  static connect(): Promise<Link> {
    const socket = new WebSocket(`ws://${window.location.host}${window.location.pathname}socket`);
    return new Promise((resolve, reject) => {
      const link = new Link(socket);
      socket.onopen = () => resolve(link);
      socket.onerror = () => reject(new Error('The program that served this page does not respond.'));
    });
  }

  // The head of the first so many worlds, or of as many as the program says.
  open(worlds: number): Promise<unknown> {
    return new Promise((resolve) => {
      this.head = resolve;
      this.send({ do: 'open', worlds });
    });
  }

  // After what is to be sent later.
  send(message: object): void {
    this.flush();
    this.write(message);
  }

  // Sent with the next flush(), instead of what was there under that name.
  later(name: string, message: object): void {
    this.pending.set(name, message);
  }

  flush(): void {
    for (const message of this.pending.values()) this.write(message);
    this.pending.clear();
  }

  private write(message: object): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  private received(data: ArrayBuffer | string): void {
    if (typeof data !== 'string') {
      this.listener?.frame(frameOf(data, this.planar, this.turned));
      return;
    }
    const message = JSON.parse(data) as { head?: unknown; said?: string; sizes?: Sized[][] };
    if (message.head !== undefined) this.head?.(message.head);
    if (message.said !== undefined) this.listener?.said(message.said);
    if (message.sizes !== undefined) this.listener?.sizes(message.sizes);
  }
}
