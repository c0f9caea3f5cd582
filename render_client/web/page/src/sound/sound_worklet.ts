// Runs the synth where the browser makes its sound.
import type { SoundWish } from '../shared/messages';
import { MillingSynth, type SoundLoad } from './milling_synth';

declare const sampleRate: number;
declare function registerProcessor(name: string, processor: unknown): void;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}

class MillingProcessor extends AudioWorkletProcessor {
  private synth?: MillingSynth;

  constructor() {
    super();
    this.port.onmessage = (event: MessageEvent<{ wish?: SoundWish; load?: SoundLoad; isHeard?: boolean }>) => {
      const { wish, load, isHeard } = event.data;
      if (wish) this.synth = new MillingSynth(wish, sampleRate);
      if (load) this.synth?.setLoad(load, isHeard ?? false);
    };
  }

  process(_inputs: Float32Array[][], outputs: Float32Array[][]): boolean {
    this.synth?.render(outputs[0][0]);
    return true;
  }
}

registerProcessor('milling', MillingProcessor);
