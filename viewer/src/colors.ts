// Colours: of bodies by index, and of numbers by a scale.

// Fixed things, and bodies by their index: told apart also by those who see few colours.
export const PALETTE = ['#e4572e', '#f3a712', '#3f6fb5', '#76b041', '#8f5aa8', '#2aa6a1', '#d1698c', '#b08968'];
export const LOST_COLOR = '#e02b2b';

// Viridis, at nine places (matplotlib, CC0), and its straight lines between them.
const SCALE = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];

export type Rgb = [number, number, number]; // linear light, 0 to 1

export function srgb(hex: string): Rgb {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255) as Rgb;
}

export function linear(hex: string): Rgb {
  return srgb(hex).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as Rgb;
}

const STEPS = 256;
const table = new Float32Array(3 * STEPS);
{
  const places = SCALE.map(linear);
  for (let i = 0; i < STEPS; ++i) {
    const x = (i / (STEPS - 1)) * (places.length - 1);
    const low = Math.min(Math.floor(x), places.length - 2);
    for (let c = 0; c < 3; ++c) {
      table[3 * i + c] = places[low][c] + (x - low) * (places[low + 1][c] - places[low][c]);
    }
  }
}

// Linear light at 0 <= x <= 1 of the scale, from `at` of `out`.
export function scaleInto(x: number, out: Float32Array, at: number): void {
  const i = 3 * Math.max(0, Math.min(STEPS - 1, Math.round(x * (STEPS - 1))));
  out[at] = table[i];
  out[at + 1] = table[i + 1];
  out[at + 2] = table[i + 2];
}

// Its places, from 0 to 1.
export const scaleStops = SCALE.map((color, i): [number, string] => [i / (SCALE.length - 1), color]);
