// The sound of motor and burr, from speed and load: the same synth as render_client/sound/milling_synth.cpp.
import type { SoundWish } from '../shared/messages';

const kSmoothing = 0.025;  // s
const kHighest = 16000;  // Hz of a tone
const kFastest = 25000;  // rad/s
const kTouchForce = 0.5;  // N at which contact is fully heard
const kRubbing = 0.12;  // share of the cutting noise that force alone makes
const kFullForce = 10;  // N of that
const kMotorLevel = 0.3, kCuttingLevel = 0.85;
const kSlowestTurn = 8;  // Hz below which the motor is not heard
const kThinWall = 2e-3;  // m, from which on a wall sounds higher
const kNoiseMiddle = 2600, kThinNoiseMiddle = 4700;  // Hz of the band-pass: thick, and no wall left
const kNoiseWidth = 0.9, kThinNoiseWidth = 0.45;  // 1/Q of the band-pass
const kToothDepth = 0.7;
const kToneBlock = 32;
const kTurn = 2 * Math.PI;
// Multiples of the rotation frequency and their strength: the rotor, its harmonics, and the whine of the gear.
const kPartials = [[1, 1], [2, 0.45], [3, 0.3], [4, 0.14], [5, 0.1], [6, 0.07], [11, 0.1], [13, 0.06]];

export interface SoundLoad {
  spinSpeed: number;  // rad/s, either way
  burrForceN: number;
  cuttingPowerW: number;
  wallM?: number;  // from the burr to a protected structure
}

const clamp = (value: number, low: number, high: number) => Math.min(Math.max(value, low), high);
const bounded = (value: number, low: number, high: number) => (Number.isFinite(value) ? clamp(value, low, high) : 0);

export class MillingSynth {
  frequency = 0;  // of the rotation now, Hz
  private readonly weight: number;
  private readonly toneWeight: number;
  private readonly bandWeight: number;
  private target = { frequency: 0, motor: 0, cutting: 0, thinness: 0 };
  private thinness = 0;
  private pitch = 0;
  private width = 0;
  private motor = 0;
  private cutting = 0;
  private readonly phases = new Float64Array(kPartials.length);
  private readonly levels = new Float64Array(kPartials.length);
  private readonly wanted = new Float64Array(kPartials.length);
  private toothPhase = 0;
  private low = 0;
  private band = 0;
  private random = 0x9e3779b9;
  private toUpdate = 0;

  constructor(private readonly wish: SoundWish, private readonly sampleRate: number) {
    const weightOf = (time: number, samples: number) => 1 - Math.exp(-samples / (time * sampleRate));
    this.weight = weightOf(kSmoothing, 1);
    this.toneWeight = weightOf(0.01, 1);
    this.bandWeight = weightOf(kSmoothing, kToneBlock);
  }

  setLoad(load: SoundLoad, is_heard: boolean): void {
    const { wish } = this;
    const frequency = Math.abs(bounded(load.spinSpeed, -kFastest, kFastest)) / kTurn;
    const force = bounded(load.burrForceN, 0, 1000), power = bounded(load.cuttingPowerW, 0, 1e4);
    const contact = Math.min(1, Math.max(force / kTouchForce, power / (0.05 * wish.fullPowerW)));
    const turning = clamp((frequency - kSlowestTurn) / kSlowestTurn, 0, 1);
    const speed = turning * Math.sqrt(Math.min(1, frequency / (wish.fullSpeedRpm / 60)));
    const level = is_heard ? wish.volume : 0;
    const rubbing = kRubbing * Math.min(1, force / kFullForce), cutting = Math.min(1, Math.sqrt(power / wish.fullPowerW));
    this.target = {
      frequency,
      motor: level * kMotorLevel * speed * (wish.idleLevel + (1 - wish.idleLevel) * contact),
      cutting: level * kCuttingLevel * turning * Math.max(cutting, rubbing),
      thinness: clamp(1 - (Number.isFinite(load.wallM) ? load.wallM! : kThinWall) / kThinWall, 0, 1),
    };
  }

  render(samples: Float32Array): void {
    for (let i = 0; i < samples.length; ++i) {
      if (this.toUpdate-- === 0) {
        this.updateTones();
        this.updateBand();
        this.toUpdate = kToneBlock - 1;
      }
      samples[i] = this.next();
    }
  }

  // A tone that would be too high is gone before it gets there.
  private updateTones(): void {
    kPartials.forEach(([multiple, strength], i) => {
      this.wanted[i] = strength * clamp(2 * (1 - (this.frequency * multiple) / kHighest), 0, 1);
    });
  }

  private updateBand(): void {
    this.thinness += this.bandWeight * (this.target.thinness - this.thinness);
    const middle = kNoiseMiddle * (kThinNoiseMiddle / kNoiseMiddle) ** this.thinness;
    this.pitch = 2 * Math.sin((Math.PI * middle) / this.sampleRate);
    this.width = kNoiseWidth + (kThinNoiseWidth - kNoiseWidth) * this.thinness;
  }

  private noise(): number {
    let r = this.random;
    r ^= r << 13;
    r ^= r >>> 17;
    r ^= r << 5;
    this.random = r;
    return (r >>> 0) / 0x80000000 - 1;
  }

  private next(): number {
    this.frequency += this.weight * (this.target.frequency - this.frequency);
    this.motor += this.weight * (this.target.motor - this.motor);
    this.cutting += this.weight * (this.target.cutting - this.cutting);
    const turn = this.frequency / this.sampleRate;
    let tones = 0;
    for (let i = 0; i < kPartials.length; ++i) {
      this.levels[i] += this.toneWeight * (this.wanted[i] - this.levels[i]);
      this.phases[i] = (this.phases[i] + turn * kPartials[i][0]) % 1;
      tones += this.levels[i] * Math.sin(kTurn * this.phases[i]);
    }
    this.toothPhase = (this.toothPhase + turn * this.wish.flutes) % 1;
    // This is Chamberlin's state variable filter (Dodge, Jerse: Computer Music, 1997).
    this.low += this.pitch * this.band;
    this.band += this.pitch * (this.noise() - this.low - this.width * this.band);
    const tooth = 1 - kToothDepth * 0.5 * (1 + Math.cos(kTurn * this.toothPhase));
    return Math.tanh(this.motor * tones + this.cutting * tooth * this.band);
  }
}
