// Plays the milling sound once the user has switched it on; before that a browser would not let it.
import type { Session } from '../session';

export class SoundPlayer {
  isOn = false;
  private context?: AudioContext;
  private node?: AudioWorkletNode;
  private wishText = '';

  // True if there is something to hear.
  static isOffered(session: Session): boolean {
    return session.scene?.sound !== undefined && typeof AudioWorkletNode !== 'undefined';
  }

  async toggle(): Promise<void> {
    this.isOn = !this.isOn;
    if (!this.isOn) {
      await this.context?.suspend();
      return;
    }
    if (!this.context) {
      const context = (this.context = new AudioContext());
      await context.audioWorklet.addModule('sound.js');
      this.node = new AudioWorkletNode(context, 'milling', { numberOfInputs: 0, outputChannelCount: [1] });
      this.node.connect(context.destination);
    }
    await this.context.resume();
  }

  update(session: Session): void {
    const wish = session.scene?.sound;
    if (!this.node || !this.isOn || !wish) return;
    const text = JSON.stringify(wish);
    if (text !== this.wishText) this.node.port.postMessage({ wish });
    this.wishText = text;
    const effects = session.tool?.effects;
    const load = {
      spinSpeed: effects?.spinSpeed ?? 0, burrForceN: effects?.burrForceN ?? 0, cuttingPowerW: effects?.cuttingPowerW ?? 0,
      wallM: effects?.protectedDistanceM,
    };
    this.node.port.postMessage({ load, isHeard: session.isLive && !session.hasEnded });
  }
}
