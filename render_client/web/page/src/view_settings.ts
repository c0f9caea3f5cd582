// What the user of this page chose to see.
import type { CutPlane, StructureMode } from './view/picture_view';

// What a drag of mouse or finger on the picture means.
export type DragMode = 'look' | 'point' | 'draw' | 'note';

export interface ViewSettings {
  cuts: CutPlane[];
  lastCut: number;  // was switched or moved last
  isTransparent: boolean;
  opacity: number;
  structures: StructureMode;
  isEndoscope: boolean;
  showsForce: boolean;
  showsFigures: boolean;
  showsDetails: boolean;
  showsRemarks: boolean;
  following: string;  // the sender whose camera is shown; empty: one's own
  mode: DragMode;
  textScale: number;
}

export function firstSettings(): ViewSettings {
  const cut = (): CutPlane => ({ isOn: false, position: 0.5, isFlipped: false });
  return {
    cuts: [cut(), cut(), cut()], lastCut: 0, isTransparent: false, opacity: 0.35, structures: 'exposed',
    isEndoscope: false, showsForce: true, showsFigures: true, showsDetails: false, showsRemarks: true, following: '',
    mode: 'look', textScale: 1,
  };
}

export function nextStructureMode(mode: StructureMode): StructureMode {
  return mode === 'exposed' ? 'behind' : mode === 'behind' ? 'off' : 'exposed';
}
