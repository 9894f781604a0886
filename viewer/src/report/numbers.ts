// How numbers are written for people.

function digits(value: number, count = 3): string {
  return String(Number(value.toPrecision(count)));
}

// "12.3", "4.5e-7": three significant digits.
export function short(value: number, count = 3): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) {
    return value.toExponential(count - 1).replace(/\.?0*e/, 'e').replace('e+', 'e');
  }
  return digits(value, count);
}

// "263 k", "12.3 M"
export function prefixed(value: number): string {
  for (const [size, prefix] of [[1e12, 'T'], [1e9, 'G'], [1e6, 'M'], [1e3, 'k']] as const) {
    if (Math.abs(value) >= 0.9995 * size) return `${digits(value / size)} ${prefix}`;
  }
  return digits(value);
}

export const perSecond = (value: number): string => `${prefixed(value)}/s`;

// "12.3 ms" of seconds
export function duration(seconds: number): string {
  for (const [size, unit] of [[1, 's'], [1e-3, 'ms'], [1e-6, 'µs']] as const) {
    if (seconds >= 0.9995 * size) return `${digits(seconds / size)} ${unit}`;
  }
  return `${digits(seconds / 1e-9)} ns`;
}

// "2.57 mm" of metres
export const length = (meters: number): string => (Math.abs(meters) < 0.1 ? `${digits(1e3 * meters)} mm` : `${digits(meters)} m`);

const RAISED = '⁰¹²³⁴⁵⁶⁷⁸⁹';
// "10⁻⁷" of a power of ten
export function powerOfTen(value: number): string {
  const exponent = Math.round(Math.log10(value));
  if (exponent >= -2 && exponent <= 3) return digits(value, 6);
  const raised = [...String(Math.abs(exponent))].map((d) => RAISED[Number(d)]).join('');
  return `10${exponent < 0 ? '⁻' : ''}${raised}`;
}

// "m^2/s^2" with raised digits
export const raised = (text: string): string => text.replace(/\^(\d)/g, (_, digit: string) => RAISED[Number(digit)]);

export function counted(count: number, noun: string, many = `${noun}s`): string {
  return `${count} ${count === 1 ? noun : many}`;
}
