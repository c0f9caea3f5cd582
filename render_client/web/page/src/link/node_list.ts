// What the page holds of the bone: which leaf with which revision. The newer epoch wins, then the newer revision, as
// docs/reference/topics.md says; and there is a bound to what a hostile server can make a browser hold.
import { demand } from './checks';

const kMostNodes = 65536;
const kMostTriangles = 12_000_000;

interface Held {
  revision: number;
  triangles: number;
}

export class NodeList {
  epoch = 0n;
  private readonly held = new Map<number, Held>();
  private triangles = 0;

  // True when this is a newer run of the server: what was held is no longer.
  begins(epoch: bigint): boolean {
    if (epoch <= this.epoch) return false;
    this.epoch = epoch;
    this.held.clear();
    this.triangles = 0;
    return true;
  }

  isNews(leaf: number, epoch: bigint, revision: number): boolean {
    const old = this.held.get(leaf);
    return epoch === this.epoch && (!old || revision > old.revision);
  }

  hold(leaf: number, revision: number, triangles: number): void {
    this.drop(leaf);
    demand(this.held.size < kMostNodes && this.triangles + triangles <= kMostTriangles, 'model too large');
    this.held.set(leaf, { revision, triangles });
    this.triangles += triangles;
  }

  drop(leaf: number): boolean {
    this.triangles -= this.held.get(leaf)?.triangles ?? 0;
    return this.held.delete(leaf);
  }

  get size(): number {
    return this.held.size;
  }
  leaves(): number[] {
    return [...this.held.keys()];
  }
  revisions(): number[] {
    return [...this.held.values()].map((node) => node.revision);
  }
}
