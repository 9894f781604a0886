// The JSON of `manyworlds report`, as the program puts it into the page.

export interface Report<Results> {
  report: string;
  version: string;
  machine: string;
  date?: string; // UTC
  quick: boolean;
  results: Results;
}

export type Precision = 'f32' | 'f64';

export interface AccuracyPoint {
  method: string;
  precision: Precision;
  step_s: number;
  error: number | null; // null: the world was lost
  us_per_world: number;
  steps_per_s: number;
}

export interface Published {
  engine: string;
  step_s: number;
  error: number | null;
  seconds: number | null; // of wall time, there
}

export interface AccuracyCase {
  id: string;
  title: string;
  metric: string;
  unit: string;
  level: number; // the error that is asked for
  simulated_s: number;
  points: AccuracyPoint[];
  cheapest_at_level: AccuracyPoint[];
  published: Published[];
}

export interface Verdict {
  id: string;
  title: string;
  group?: string;
  criterion: string;
  unit: string;
  limit: number;
  setting: string;
  value: number | null; // of the worst world; null: not finite
  lost_worlds: number;
  passed: boolean;
  note: string;
}

// A family in one precision and one choice of units.
export interface InvariantRow {
  family: string;
  law: string;
  title: string;
  criterion: string;
  unit: string;
  units: string; // similar or earth
  precision: Precision;
  worlds: number;
  broken: number;
  share: number; // of worlds that break the law
  silent: number;
  lost: number;
  limit: number;
  worst: number | null; // null: not finite
  worst_world: number;
  seed: number;
  required: boolean;
  passed: boolean;
  command: string; // records the worst world
}

export interface WorthRow {
  scene: string;
  variant: string;
  bodies?: number;
  world_steps_per_s: number; // as by default
  time_ratio: number; // of the variant, by that as by default
  same_bits: boolean;
  must_be_same: boolean;
  holds?: string;
}

export interface ThroughputRow {
  sweep: string;
  scene: string;
  value: string;
  worlds: number;
  threads: number;
  world_steps_per_s: number;
  body_steps_per_s: number;
  bytes_per_world: number;
  bandwidth_share: number;
  stage_split: Record<string, number>;
  hash: string;
}

export interface PeerErrors {
  worst_overlap_m: number | null;
  worst_gap_m: number | null;
}

export interface PeerEngine extends PeerErrors {
  engine: string;
  version: string;
  rounds: number; // that it took part in
  world_steps_per_s: number;
  ratio: number; // how often as fast manyworlds is
  long_visit: { world_steps_per_s: number; ratio: number } | null; // with more steps of a world before the next one's
  settings: string;
}

export interface PeerScene extends PeerErrors {
  scene: string;
  world_steps_per_s: number;
  long_visit: number; // of manyworlds
  engines: PeerEngine[]; // the fastest first
}

export interface Throughput {
  gflops: number;
  gigabytes_per_s: number;
  rows: ThroughputRow[];
  peer_protocol?: { worlds: number; steps: number; rounds: number; long_visit: number };
  peers?: PeerScene[];
  peer_means?: { ratio: number | null; long_visit: number | null };
  peer_failures?: string[];
}
