// Names and notes at places in the picture.
import type { Vec3 } from '../math/linear';
import { pixelOf, type Camera } from '../view/camera';
import { byId, make, setText } from './dom';

export interface Label {
  p_W: Vec3;
  text: string;
  kind: 'pointer' | 'note' | 'name';
}

export class Labels {
  private readonly spans: HTMLSpanElement[] = [];

  // In CSS pixels.
  update(labels: Label[], camera: Camera, width: number, height: number): void {
    let n = 0;
    for (const label of labels) {
      const at = pixelOf(camera, label.p_W, width, height);
      if (!at || at.x < 0 || at.y < 0 || at.x > width || at.y > height) continue;
      const span = this.spans[n] ?? this.another();
      ++n;
      span.hidden = false;
      span.className = label.kind;
      setText(span, label.text);
      span.style.transform = `translate(${(at.x + 12).toFixed(1)}px, ${(at.y - 12).toFixed(1)}px)`;
    }
    for (const span of this.spans.slice(n)) span.hidden = true;
  }

  private another(): HTMLSpanElement {
    const span = make('span');
    this.spans.push(span);
    byId('labels').append(span);
    return span;
  }
}
