// The picture: which view of the session is drawn, when, and what is under a place of it.
import { angleBetween, cornersOf, norm, placed, sub, type Vec3 } from './math/linear';
import type { FromLink, PlacedNode, SceneView, StructureSurface, ToolView } from './shared/messages';
import { Pace } from './pace';
import type { Session } from './session';
import type { Place, ToolHold } from './tool_hold';
import { Labels, type Label } from './ui/labels';
import { loadOf, workOf } from './ui/words';
import { endoscopeCamera, Orbit, type Camera } from './view/camera';
import { openCanvas } from './view/gl';
import { nearStructures } from './view/near_structures';
import type { Ghost, PictureView, Stroke } from './view/picture_view';
import { Renderer } from './view/renderer';
import { linearColour, structureColour } from './view/structure_colours';
import type { ViewSettings } from './view_settings';

const kGhostDistance = 1.5e-4, kGhostAngle = 0.03;  // m, rad
const kHandColour: Vec3 = [0.35, 0.8, 1], kExpertColour: Vec3 = [1, 0.55, 0.08];  // linear
const kMostPixelRatio = 2;
const kGlowSteps = 4;

function ghostsOf({ X_WT, X_WT_device, X_WT_expert }: ToolView): Ghost[] {
  const isHandSeen = norm(sub(X_WT.p, X_WT_device.p)) > kGhostDistance || angleBetween(X_WT.q, X_WT_device.q) > kGhostAngle;
  return [
    ...(isHandSeen ? [{ X_WT: X_WT_device, colour: kHandColour }] : []),
    ...(X_WT_expert ? [{ X_WT: X_WT_expert, colour: kExpertColour }] : []),
  ];
}

export class Stage {
  orbit = new Orbit();
  pace: Pace;
  ownPointer?: Vec3;
  preview?: Stroke;  // being drawn
  private renderer: Renderer;
  private readonly structures = new Map<number, StructureSurface>();
  private isNearStale = false;  // what shines through bone
  private kept: PlacedNode[] = [];  // while there is no context
  private readonly labels = new Labels();
  private frame = 0;
  private timer?: ReturnType<typeof setTimeout>;
  private sceneName?: string;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly session: Session,
    private readonly settings: ViewSettings,
    private readonly hold: ToolHold,
    private readonly drawn: () => void,
  ) {
    const opened = openCanvas(canvas);
    if (!opened) throw new Error('This browser has no WebGL 2, which the picture needs.');
    this.renderer = new Renderer(opened);
    this.pace = new Pace(opened.isSoftware);
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.kept = this.renderer.bonePainter.bone.all();
    });
    canvas.addEventListener('webglcontextrestored', () => this.makeAnew({ gl: opened.gl, isSoftware: opened.isSoftware }));
    new ResizeObserver(() => this.invalidate(true)).observe(canvas);
  }

  get nodes(): number {
    return this.renderer.bonePainter.bone.nodes;
  }
  get triangles(): number {
    return this.renderer.bonePainter.bone.triangles;
  }

  take(message: FromLink): void {
    const { bonePainter, toolPainter } = this.renderer;
    switch (message.kind) {
      case 'epoch':
        bonePainter.clear();
        this.structures.clear();
        this.isNearStale = true;
        break;
      case 'scene':
        this.isNearStale = true;
        bonePainter.setMaterials(message.scene.materials);
        toolPainter.set(message.scene.tool);
        if (message.scene.name !== this.sceneName) this.firstView();
        this.sceneName = message.scene.name;
        break;
      case 'structure':
        bonePainter.setStructure(message.id, message.surface);
        if (message.surface) this.structures.set(message.id, message.surface);
        else this.structures.delete(message.id);
        this.isNearStale = true;
        break;
      case 'nodes':
        for (const leaf of message.gone) bonePainter.bone.remove(leaf);
        for (const node of message.placed) bonePainter.bone.set(node);
        this.session.showNodes(this.nodes);
        // Until all are there each picture is another one anyway.
        if (!this.session.hasBeenComplete) this.pace.noteChange(performance.now());
        return this.invalidate();
      case 'tool':
      case 'viewer':
      case 'remark':
        return this.invalidate();
      default:
        return;
    }
    this.renderer.noteChange();
    this.pace.noteChange(performance.now());
    this.invalidate();
  }

  firstView(): void {
    const scene = this.session.scene;
    if (!scene) return;
    const box = { low: scene.boneLow, high: scene.boneHigh };
    const corners = cornersOf(box).map((corner) => placed(scene.X_WV, corner));
    const wish = scene.camera ?? { distance: 0, azimuth: 0.61, elevation: 0.44 };
    this.orbit = Orbit.of(wish, corners, this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight));
    this.invalidate(true);
  }

  // Something is to be seen that was not; `has_moved`: the view.
  invalidate(has_moved = false): void {
    if (has_moved) this.pace.noteMove(performance.now());
    this.frame ||= requestAnimationFrame((now) => this.draw(now));
  }

  camera(): Camera {
    const { tool, scene } = this.session;
    if (this.settings.isEndoscope && tool && scene) return endoscopeCamera(tool.X_WT, scene.burrRadius);
    return this.orbit.view();
  }

  look(): { camera: Camera; width: number; height: number } {
    return { camera: this.camera(), width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  // The point of the bone (W) at that place, in CSS pixels.
  pick(at: Place): Vec3 | undefined {
    return this.renderer.pick((2 * at.x) / this.canvas.clientWidth - 1, 1 - (2 * at.y) / this.canvas.clientHeight);
  }

  private makeAnew(canvas: ConstructorParameters<typeof Renderer>[0]): void {
    this.renderer = new Renderer(canvas);
    const { bonePainter, toolPainter } = this.renderer, scene = this.session.scene;
    for (const node of this.kept) bonePainter.bone.set(node);
    this.kept = [];
    for (const [id, surface] of this.structures) bonePainter.setStructure(id, surface);
    this.isNearStale = true;
    if (scene) {
      bonePainter.setMaterials(scene.materials);
      toolPainter.set(scene.tool);
    }
    this.invalidate(true);
  }

  private draw(now: number): void {
    this.frame = 0;
    const ratio = Math.min(window.devicePixelRatio || 1, kMostPixelRatio);
    if (this.settings.isEndoscope) this.pace.noteMove(now);
    const { isFine, isMoving, share } = this.pace.next(now), view = this.view();
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio * share));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio * share));
    // The browser stretches a canvas of fewer pixels.
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.renderer.draw(view, width, height, isFine, isMoving);
    this.labels.update(this.labelsOf(), view.camera, this.canvas.clientWidth, this.canvas.clientHeight);
    clearTimeout(this.timer);
    if (!isFine) this.timer = setTimeout(() => this.invalidate(), this.pace.restsIn(performance.now()) + 5);
    this.drawn();
  }

  private view(): PictureView {
    const { session, settings } = this, { scene, tool } = session;
    if (scene) this.prepareNear(scene);
    const X_WT = tool?.X_WT;
    const isEndoscope = settings.isEndoscope && tool !== undefined && scene !== undefined;
    return {
      camera: this.camera(),
      isEndoscope,
      X_WV: scene?.X_WV ?? { p: [0, 0, 0], q: [1, 0, 0, 0] },
      bone_V: scene ? { low: scene.boneLow, high: scene.boneHigh } : { low: [-0.01, -0.01, -0.01], high: [0.01, 0.01, 0.01] },
      burrRadius: scene?.burrRadius ?? 0,
      X_WT: scene && X_WT,
      ghosts: scene && tool ? ghostsOf(tool) : [],
      toolReach: this.renderer.toolPainter.reach,
      forceN: settings.showsForce ? tool?.forceN : undefined,
      wish: this.hold.isHolding ? this.hold.wish.p : undefined,
      work: workOf(tool),
      load: loadOf(tool),
      cuts: settings.cuts,
      opacity: settings.isTransparent ? settings.opacity : undefined,
      structures: this.structureLooks(),
      structureMode: settings.structures,
      pointers: this.pointers().map(({ at }) => at),
      strokes: this.strokes(),
    };
  }

  // Made anew where structures came or went, before the next picture.
  private prepareNear(scene: SceneView): void {
    if (!this.isNearStale) return;
    this.isNearStale = false;
    const coloured = [...this.structures.values()].map((surface) => (
      { surface, colour: linearColour(structureColour(scene, surface.id)) }));
    this.renderer.bonePainter.setNear(nearStructures(coloured));
  }

  private structureLooks(): PictureView['structures'] {
    const scene = this.session.scene, effects = this.session.tool?.effects;
    if (!scene) return [];
    return [...this.structures.values()].map(({ id, warningDistance }) => {
      const distance = effects?.protectedId === id ? (effects.protectedDistanceM ?? Infinity) : Infinity;
      const share = Math.min(Math.max(1 - distance / warningDistance, 0), 1);
      return { id, colour: linearColour(structureColour(scene, id)), glow: Math.ceil(kGlowSteps * share) / kGlowSteps };
    });
  }

  private pointers(): { at: Vec3; name: string }[] {
    const others = this.session.others(Date.now()).flatMap((one) => (one.pointer ? [{ at: one.pointer, name: one.name }] : []));
    return this.ownPointer ? [...others, { at: this.ownPointer, name: '' }] : others;
  }

  private strokes(): Stroke[] {
    const shown = this.settings.showsRemarks ? [...this.session.remarks.values()].filter((one) => one.points.length > 1) : [];
    return this.preview ? [...shown, this.preview] : shown;
  }

  private labelsOf(): Label[] {
    const labels: Label[] = this.pointers().filter(({ name }) => name).map(({ at, name }) => ({ p_W: at, text: name, kind: 'pointer' }));
    if (this.settings.showsRemarks)
      for (const one of this.session.remarks.values())
        if (one.note && one.points.length > 0) labels.push({ p_W: one.points[0], text: one.note, kind: 'note' });
    return labels;
  }
}

