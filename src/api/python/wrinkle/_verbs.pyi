# Written by make_stub.py from the table of commands.
from os import PathLike
from typing import Any, Literal, Sequence

def export_words(kind: str, options: dict[str, Any]) -> bytes: ...

class Verbs:
    def run(self, line: str) -> None: ...

    def table(
        self, *_values: Any, wrap: Literal['periodic', 'clamp-u', 'clamp-v', 'clamp'] | None = ...
    ) -> None:
        """Create a table of heights 0."""

    def fill(
        self, *_values: Any
    ) -> None:
        """Set all heights to a constant."""

    def grid(
        self, *, cells: Sequence[int] | None = ..., width: float | None = ..., low: float | None = ..., high: float |
        None = ...
    ) -> None:
        """Replace the heights by a grid of lines."""

    def image(
        self, *_values: Any, fit: Literal['table'] | None = ..., layer: Any | None = ..., part: Any | None = ...,
        labels: Literal['use', 'ignore'] | None = ..., sha256: str | None = ...
    ) -> None:
        """Read the heights from a picture."""

    def dab(
        self, *_values: Any, radius: float | None = ..., hardness: float | None = ..., strength: float | None = ...,
        mode: Literal['raise', 'lower', 'to', 'flatten', 'lift', 'cut', 'erase', 'clone', 'sharpen', 'dilate', 'erode',
        'smooth', 'level', 'pinch', 'smear'] | None = ..., to: float | None = ..., opacity: float | None = ..., reach:
        float | None = ..., source: Sequence[float] | None = ..., flow: float | None = ..., buildup: bool | str | None =
        ..., spacing: float | None = ..., pressure: Literal['strength', 'size', 'both', 'none'] | None = ..., preset:
        str | None = ..., preset_sha256: str | None = ..., set: Any | None = ..., seed: float | None = ..., tip: str |
        PathLike[str] | None = ..., tip_sha256: str | None = ..., angle: float | None = ..., aspect: float | None = ...,
        follow: bool | str | None = ..., jitter: Sequence[float] | None = ..., mirror: Literal['none', 'u', 'v', 'uv'] |
        None = ..., radial: float | None = ..., centre: Sequence[float] | None = ..., repeat: Sequence[int] | None =
        ..., stagger: float | None = ...
    ) -> None:
        """Paint one dab."""

    def stroke(
        self, *, points: Any | None = ..., radius: float | None = ..., hardness: float | None = ..., strength: float |
        None = ..., mode: Literal['raise', 'lower', 'to', 'flatten', 'lift', 'cut', 'erase', 'clone', 'sharpen',
        'dilate', 'erode', 'smooth', 'level', 'pinch', 'smear'] | None = ..., to: float | None = ..., opacity: float |
        None = ..., reach: float | None = ..., source: Sequence[float] | None = ..., flow: float | None = ..., buildup:
        bool | str | None = ..., spacing: float | None = ..., pressure: Literal['strength', 'size', 'both', 'none'] |
        None = ..., preset: str | None = ..., preset_sha256: str | None = ..., set: Any | None = ..., seed: float | None
        = ..., tip: str | PathLike[str] | None = ..., tip_sha256: str | None = ..., angle: float | None = ..., aspect:
        float | None = ..., follow: bool | str | None = ..., jitter: Sequence[float] | None = ..., mirror:
        Literal['none', 'u', 'v', 'uv'] | None = ..., radial: float | None = ..., centre: Sequence[float] | None = ...,
        repeat: Sequence[int] | None = ..., stagger: float | None = ...
    ) -> None:
        """Paint a stroke along a path."""

    def sculpt(
        self, *, points: Any | None = ..., eye: Sequence[float] | None = ..., mirror_axes: Literal['none', 'x', 'y',
        'xy', 'z', 'xz', 'yz', 'xyz'] | None = ..., mirror_at: Sequence[float] | None = ..., radius: float | None = ...,
        hardness: float | None = ..., strength: float | None = ..., mode: Literal['raise', 'lower', 'to', 'flatten',
        'lift', 'cut', 'erase', 'clone', 'sharpen', 'dilate', 'erode', 'smooth', 'level', 'pinch', 'smear'] | None =
        ..., to: float | None = ..., opacity: float | None = ..., reach: float | None = ..., source: Sequence[float] |
        None = ..., flow: float | None = ..., buildup: bool | str | None = ..., spacing: float | None = ..., pressure:
        Literal['strength', 'size', 'both', 'none'] | None = ..., preset: str | None = ..., preset_sha256: str | None =
        ..., set: Any | None = ..., seed: float | None = ..., tip: str | PathLike[str] | None = ..., tip_sha256: str |
        None = ..., angle: float | None = ..., aspect: float | None = ..., follow: bool | str | None = ..., jitter:
        Sequence[float] | None = ..., mirror: Literal['none', 'u', 'v', 'uv'] | None = ..., radial: float | None = ...,
        centre: Sequence[float] | None = ..., repeat: Sequence[int] | None = ..., stagger: float | None = ...
    ) -> None:
        """Paint a stroke on the object's mesh."""

    def project(
        self, *_values: Any, eye: Sequence[float] | None = ..., at: Sequence[float] | None = ..., up: Sequence[float] |
        None = ..., width: float | None = ..., parallel: bool | str | None = ..., into: Literal['active', 'new'] | None
        = ..., strength: float | None = ..., mode: Literal['raise', 'lower', 'to', 'flatten', 'lift', 'cut', 'erase',
        'clone', 'sharpen', 'dilate', 'erode', 'smooth', 'level', 'pinch', 'smear'] | None = ..., to: float | None =
        ..., opacity: float | None = ..., reach: float | None = ..., source: Sequence[float] | None = ...
    ) -> None:
        """Project a layer onto the object's mesh."""

    def shape(
        self, _form: Literal['rectangle', 'ellipse', 'polygon', 'path'], /, *, radius: float | None = ..., hardness:
        float | None = ..., strength: float | None = ..., mode: Literal['raise', 'lower', 'to', 'flatten', 'lift',
        'cut', 'erase', 'clone', 'sharpen', 'dilate', 'erode', 'smooth', 'level', 'pinch', 'smear'] | None = ..., to:
        float | None = ..., opacity: float | None = ..., reach: float | None = ..., source: Sequence[float] | None =
        ..., flow: float | None = ..., buildup: bool | str | None = ..., spacing: float | None = ..., pressure:
        Literal['strength', 'size', 'both', 'none'] | None = ..., preset: str | None = ..., preset_sha256: str | None =
        ..., set: Any | None = ..., seed: float | None = ..., tip: str | PathLike[str] | None = ..., tip_sha256: str |
        None = ..., angle: float | None = ..., aspect: float | None = ..., follow: bool | str | None = ..., jitter:
        Sequence[float] | None = ..., mirror: Literal['none', 'u', 'v', 'uv'] | None = ..., radial: float | None = ...,
        centre: Sequence[float] | None = ..., repeat: Sequence[int] | None = ..., stagger: float | None = ..., a:
        Sequence[float] | None = ..., b: Sequence[float] | None = ..., corner: float | None = ..., turn: float | None =
        ..., paint: Literal['outline', 'fill'] | None = ..., at: Sequence[float] | None = ..., radii: Sequence[float] |
        None = ..., points: Any | None = ..., closed: bool | str | None = ...
    ) -> None:
        """Draw or fill a rectangle, an ellipse, a polygon or a path."""

    def flood(
        self, *_values: Any, tolerance: float | None = ..., diagonal: bool | str | None = ..., strength: float | None =
        ..., mode: Literal['raise', 'lower', 'to', 'flatten', 'lift', 'cut', 'erase', 'clone', 'sharpen', 'dilate',
        'erode', 'smooth', 'level', 'pinch', 'smear'] | None = ..., to: float | None = ..., opacity: float | None = ...,
        reach: float | None = ..., source: Sequence[float] | None = ...
    ) -> None:
        """Fill a connected region of similar height."""

    def ramp(
        self, _form: Literal['linear', 'radial', 'cone'], /, *, from_: Sequence[float] | None = ..., to: Sequence[float]
        | None = ..., low: float | None = ..., high: float | None = ..., fold: Any | None = ..., blend:
        Literal['replace', 'add', 'max', 'min'] | None = ...
    ) -> None:
        """Fill with a ramp between two points."""

    def pattern(
        self, _form: Literal['bricks', 'tiles', 'hexagons', 'planks', 'shingles', 'scales', 'weave', 'rope', 'chain',
        'grid', 'checks', 'stripes', 'waves', 'knurl', 'dots', 'voronoi', 'cracks', 'scratches'], /, *, across: float |
        None = ..., rows: float | None = ..., bond: Literal['running', 'third', 'quarter', 'stack', 'english',
        'flemish'] | None = ..., joint: float | None = ..., bevel: float | None = ..., profile: Literal['round',
        'smooth', 'chamfer', 'cove'] | None = ..., corner: float | None = ..., wobble: float | None = ..., uneven: float
        | None = ..., tilt: float | None = ..., pillow: float | None = ..., rough: float | None = ..., seed: float |
        None = ..., height: float | None = ..., origin: Sequence[float] | None = ..., blend: Literal['add', 'subtract',
        'max', 'min', 'smooth-max', 'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None =
        ..., offset: float | None = ..., shape: Any | None = ..., along: Literal['u', 'v'] | None = ..., wood: float |
        None = ..., rings: float | None = ..., ragged: float | None = ..., size: float | None = ..., ridge: float | None
        = ..., draft: Literal['plain', 'twill', 'basket', 'satin'] | None = ..., width: float | None = ..., round: float
        | None = ..., fibre: float | None = ..., turns: float | None = ..., lay: float | None = ..., groove: float |
        None = ..., wire: float | None = ..., sway: float | None = ..., swings: float | None = ..., flat: float | None =
        ..., valley: float | None = ..., layout: Literal['square', 'staggered'] | None = ..., scatter: float | None =
        ..., vary: float | None = ..., value: Literal['f1', 'f2', 'f2-f1', 'cells', 'domes'] | None = ..., metric:
        Literal['euclid', 'manhattan', 'chebyshev'] | None = ..., gap: float | None = ..., jagged: float | None = ...,
        count: float | None = ..., length: float | None = ..., angle: float | None = ..., spread: float | None = ...,
        bend: float | None = ...
    ) -> None:
        """Generate bricks, tiles, cloth, cells and other patterns."""

    def noise(
        self, _form: Literal['perlin', 'gradient', 'value', 'simplex', 'sheared', 'torus', 'cubes'], /, *, cells: float
        | None = ..., rows: float | None = ..., octaves: float | None = ..., ratio: float | None = ..., step: float |
        None = ..., mode: Literal['fbm', 'turbulence', 'billow', 'ridged'] | None = ..., seed: float | None = ...,
        scatter: Any | None = ..., warp: float | None = ..., warp_cells: float | None = ..., ridge_offset: float | None
        = ..., ridge_gain: float | None = ..., amplitude: float | None = ..., level: float | None = ..., origin:
        Sequence[float] | None = ..., fade: Literal['linear', 'cubic', 'quintic'] | None = ..., domain: Literal['plane',
        'slice', 'along-u', 'along-v'] | None = ..., slice: float | None = ..., source: Literal['hash', 'lecture'] |
        None = ..., blend: Literal['add', 'subtract', 'max', 'min', 'smooth-max', 'smooth-min', 'replace', 'mix',
        'multiply'] | None = ..., radius: float | None = ..., offset: float | None = ..., way: Literal['sheared',
        'torus', 'slice'] | None = ...
    ) -> None:
        """Generate sums of value, gradient or simplex noise."""

    def formula(
        self, _form: Literal['poly', 'fourier'], /, *, c: Any | None = ..., blend: Literal['add', 'subtract', 'max',
        'min', 'smooth-max', 'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None = ...,
        offset: float | None = ..., terms: Any | None = ...
    ) -> None:
        """Generate a polynomial or a Fourier series."""

    def text(
        self, *_values: Any, font: Literal['terminus', 'terminus-bold', 'sans', 'sans-bold', 'serif', 'serif-bold',
        'mono', 'mono-bold', 'inter', 'inter-bold'] | None = ..., file: str | PathLike[str] | None = ..., face: float |
        None = ..., axes: Any | None = ..., missing: Literal['borrow', 'sign'] | None = ..., fallback: str |
        PathLike[str] | None = ..., fallback2: str | PathLike[str] | None = ..., fallback3: str | PathLike[str] | None =
        ..., size: float | None = ..., at: Sequence[float] | None = ..., align: Literal['left', 'centre', 'right'] |
        None = ..., anchor: Literal['middle', 'baseline', 'top', 'bottom'] | None = ..., letters: float | None = ...,
        lines: float | None = ..., rotate: float | None = ..., direction: Literal['auto', 'left-to-right',
        'right-to-left'] | None = ..., language: Any | None = ..., points: Any | None = ..., around: Literal['off', 'u',
        'v', 'lattice'] | None = ..., lattice: Sequence[float] | None = ..., repeats: float | None = ..., edge:
        Literal['wrap', 'clip'] | None = ..., profile: Literal['flat', 'round', 'chisel', 'ridge', 'engraved'] | None =
        ..., bevel: float | None = ..., height: float | None = ..., blend: Literal['add', 'subtract', 'max', 'min',
        'smooth-max', 'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None = ..., offset:
        float | None = ..., fallback_sha256: str | None = ..., fallback2_sha256: str | None = ..., fallback3_sha256: str
        | None = ..., sha256: str | None = ...
    ) -> None:
        """Write letters of any font and script in relief."""

    def rim(
        self, *, kind: Literal['bevel', 'round', 'ridge', 'outline', 'emboss'] | None = ..., of: Literal['auto',
        'selection', 'mask', 'heights'] | None = ..., layer: Any | None = ..., width: float | None = ..., height: float
        | None = ..., level: float | None = ..., blend: Literal['add', 'subtract', 'max', 'min', 'smooth-max',
        'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None = ..., offset: float | None = ...
    ) -> None:
        """Bevel, round, ridge, outline or emboss along an edge."""

    def solid(
        self, _form: Literal['sphere', 'ellipsoid', 'box', 'cylinder', 'cone', 'torus', 'capsule', 'mesh', 'relief',
        'letters', 'surface'], /, *_values: Any, radius: float | None = ..., at: Sequence[float] | None = ..., rotate:
        Sequence[float] | None = ..., height: float | None = ..., sink: float | None = ..., deep: float | None = ...,
        soft: float | None = ..., across: float | None = ..., rows: float | None = ..., spacing: Sequence[float] | None
        = ..., stagger: float | None = ..., jitter: float | None = ..., alternate: float | None = ..., turn: float |
        None = ..., tilt: float | None = ..., vary: float | None = ..., seed: float | None = ..., layout:
        Literal['grid', 'hexagon', 'chance'] | None = ..., points: Any | None = ..., closed: Any | None = ..., join:
        Literal['max', 'smooth', 'add'] | None = ..., melt: float | None = ..., blend: Literal['add', 'subtract', 'max',
        'min', 'smooth-max', 'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., blend_radius: float | None = ...,
        offset: float | None = ..., radii: Sequence[float] | None = ..., size: Any | None = ..., length: float | None =
        ..., tube: float | None = ..., sha256: str | None = ..., layer: Any | None = ..., depth: float | None = ...,
        font: Literal['terminus', 'terminus-bold', 'sans', 'sans-bold', 'serif', 'serif-bold', 'mono', 'mono-bold',
        'inter', 'inter-bold'] | None = ..., file: str | PathLike[str] | None = ..., face: float | None = ..., bevel:
        float | None = ..., profile: Literal['round', 'chamfer'] | None = ..., letters: float | None = ..., lines: float
        | None = ...
    ) -> None:
        """Add solids, letters and meshes seen from above (Z-buffer)."""

    def terrain(
        self, _form: Literal['fractal', 'elevation', 'hydraulic', 'thermal', 'terraces'], /, *_values: Any, type:
        Literal['fbm', 'billow', 'ridged', 'hybrid'] | None = ..., cells: float | None = ..., octaves: float | None =
        ..., ratio: float | None = ..., step: float | None = ..., offset: float | None = ..., gain: float | None = ...,
        altitude: float | None = ..., erosion: float | None = ..., warp: float | None = ..., curve: float | None = ...,
        sea: float | None = ..., seed: float | None = ..., height: float | None = ..., level: float | None = ...,
        origin: Sequence[float] | None = ..., blend: Literal['add', 'subtract', 'max', 'min', 'smooth-max',
        'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None = ..., blend_offset: float | None
        = ..., layer: Any | None = ..., part: Any | None = ..., size: Any | None = ..., sample: Literal['auto', 'u16',
        'i16', 'f32'] | None = ..., order: Literal['little', 'big'] | None = ..., values: Literal['auto', 'code',
        'range', 'real'] | None = ..., low: float | None = ..., high: float | None = ..., scale: float | None = ...,
        holes: bool | str | None = ..., nodata: float | None = ..., labels: Literal['read', 'ignore'] | None = ...,
        seamless: Literal['off', 'blend', 'cut'] | None = ..., sha256: str | None = ..., rain: float | None = ...,
        strength: float | None = ..., capacity: float | None = ..., deposition: float | None = ..., inertia: float |
        None = ..., evaporation: float | None = ..., life: float | None = ..., blend_radius: float | None = ..., talus:
        float | None = ..., width: float | None = ..., rounds: float | None = ..., rate: float | None = ..., steps:
        float | None = ..., sharpness: float | None = ..., riser: float | None = ..., jitter: float | None = ...,
        uneven: float | None = ...
    ) -> None:
        """Generate mountains, load real elevations, erode them."""

    def picture(
        self, _form: Literal['photo', 'normals', 'paste', 'svg', 'path'], /, *_values: Any, layer: Any | None = ...,
        part: Any | None = ..., channel: Literal['luminance', 'red', 'green', 'blue', 'alpha', 'max'] | None = ...,
        light: Literal['linear', 'code'] | None = ..., seamless: Literal['off', 'blend', 'cut'] | None = ..., highpass:
        float | None = ..., stretch: bool | str | None = ..., low: float | None = ..., high: float | None = ..., gamma:
        float | None = ..., invert: bool | str | None = ..., labels: Literal['read', 'ignore'] | None = ..., height:
        float | None = ..., level: float | None = ..., blend: Literal['add', 'subtract', 'max', 'min', 'smooth-max',
        'smooth-min', 'replace', 'mix', 'multiply'] | None = ..., radius: float | None = ..., offset: float | None =
        ..., sha256: str | None = ..., y: Literal['auto', 'up', 'down'] | None = ..., edges: Literal['auto', 'periodic',
        'free'] | None = ..., slopes: Literal['auto', 'smooth', 'central'] | None = ..., codes: Literal['auto',
        'unsigned', 'signed', 'slopes', 'bump-slopes'] | None = ..., coding: Literal['auto', 'unit', 'signed'] | None =
        ..., cell: Sequence[float] | None = ..., at: Sequence[float] | None = ..., size: float | None = ..., angle:
        float | None = ..., mirror: Literal['none', 'u', 'v', 'uv'] | None = ..., filter: Literal['nearest', 'linear',
        'catmull'] | None = ..., transparent: bool | str | None = ..., take: Literal['all', 'dark', 'light'] | None =
        ..., box: Literal['drawn', 'page'] | None = ..., rotate: float | None = ..., edge: Literal['wrap', 'clip'] |
        None = ..., profile: Literal['flat', 'round', 'chisel', 'ridge', 'engraved'] | None = ..., bevel: float | None =
        ...
    ) -> None:
        """Convert pictures and normal maps to heights."""

    def link(
        self, *_values: Any, shift: Sequence[float] | None = ..., turn: float | None = ..., scale: Sequence[float] |
        None = ..., factor: float | None = ...
    ) -> None:
        """Copy the heights and the coverage of another layer or group."""

    def macro(
        self, *_values: Any, values: Any | None = ..., sha256: str | None = ...
    ) -> None:
        """Run the commands of a file as one step."""

    def open(
        self, *_values: Any, sha256: str | None = ...
    ) -> None:
        """Open a document."""

    def layer(
        self, _form: Literal['add', 'delete', 'use', 'move', 'rename', 'set', 'rasterize', 'duplicate', 'merge',
        'flatten', 'clear', 'solo', 'mask', 'paste', 'group', 'ungroup'], /, *_values: Any, from_: Any | None = ...,
        blend: Literal['add', 'subtract', 'max', 'min', 'smooth-max', 'smooth-min', 'replace', 'mix', 'multiply'] | None
        = ..., opacity: float | None = ..., radius: float | None = ..., above: int | str | None = ..., in_: Any | None =
        ..., part: Literal['heights', 'mask'] | None = ..., to: float | None = ..., change: Any | None = ..., name: str
        | None = ..., visible: bool | str | None = ..., collapsed: bool | str | None = ..., lock: bool | str | None =
        ..., linked: bool | str | None = ..., low: float | None = ..., high: float | None = ..., soft: float | None =
        ..., live: Any | None = ..., at: Sequence[float] | None = ..., size: float | None = ..., sha256: str | None =
        ..., of: int | str | None = ...
    ) -> None:
        """Add, order, merge and change layers."""

    def variant(
        self, _form: Literal['add', 'use', 'set', 'rename', 'delete'], /, *_values: Any
    ) -> None:
        """Store and apply sets of layer settings."""

    def select(
        self, _form: Literal['all', 'none', 'invert', 'rect', 'ellipse', 'lasso', 'height', 'slope', 'flood', 'mask',
        'grow', 'shrink', 'feather'], /, *_values: Any, from_: Sequence[float] | None = ..., to: Sequence[float] | None
        = ..., mode: Literal['replace', 'add', 'subtract', 'intersect'] | None = ..., at: Sequence[float] | None = ...,
        radii: Sequence[float] | None = ..., points: Any | None = ..., low: float | None = ..., high: float | None =
        ..., soft: float | None = ..., relief: float | None = ..., tolerance: float | None = ..., diagonal: bool | str |
        None = ..., by: float | None = ...
    ) -> None:
        """Select where edits act."""

    def transform(
        self, *, move: Sequence[float] | None = ..., turn: float | None = ..., scale: Sequence[float] | None = ...,
        about: Sequence[float] | None = ..., blend: Literal['replace', 'add', 'subtract', 'max', 'min', 'multiply'] |
        None = ..., leave: bool | str | None = ..., filter: Literal['nearest', 'linear', 'catmull'] | None = ...,
        layers: Literal['active', 'all'] | None = ..., of: int | str | None = ...
    ) -> None:
        """Move, rotate, scale and mirror the selection or a whole layer."""

    def adjust(
        self, _form: Literal['offset', 'flip-u', 'flip-v', 'rotate', 'crop', 'resize', 'seamless', 'match-edges',
        'even-light', 'levels', 'curves', 'invert', 'normalise', 'add', 'multiply', 'clamp', 'blur', 'sharpen',
        'median', 'dilate', 'erode', 'slope-limit', 'noise', 'warp'], /, *, du: float | None = ..., dv: float | None =
        ..., layers: Literal['active', 'all'] | None = ..., angle: Literal['90', '180', '270'] | None = ..., x: float |
        None = ..., y: float | None = ..., width: float | None = ..., height: float | None = ..., filter: Literal['box',
        'linear', 'catmull', 'lanczos3'] | None = ..., how: Literal['blend', 'patches', 'mirror', 'frequency'] | None =
        ..., ramp: Literal['smooth', 'linear'] | None = ..., sigma: float | None = ..., in_low: float | None = ...,
        in_high: float | None = ..., gamma: float | None = ..., out_low: float | None = ..., out_high: float | None =
        ..., points: Any | None = ..., about: Literal['range', 'zero'] | None = ..., low: float | None = ..., high:
        float | None = ..., amount: float | None = ..., factor: float | None = ..., radius: float | None = ..., window:
        Literal['round', 'square'] | None = ..., limit: float | None = ..., side: Literal['below', 'above', 'mean'] |
        None = ..., cells: float | None = ..., octaves: float | None = ..., kind: Literal['perlin', 'gradient', 'value',
        'sheared'] | None = ..., mode: Literal['fbm', 'turbulence', 'billow', 'ridged'] | None = ..., seed: float | None
        = ..., between: Literal['catmull', 'linear'] | None = ...
    ) -> None:
        """Change a whole table: blur, levels, resize and the like."""

    def filter(
        self, _form: Literal['offset', 'flip-u', 'flip-v', 'seamless', 'match-edges', 'even-light', 'levels', 'curves',
        'invert', 'normalise', 'add', 'multiply', 'clamp', 'blur', 'sharpen', 'median', 'dilate', 'erode',
        'slope-limit', 'noise', 'warp'], /, *, du: float | None = ..., dv: float | None = ..., layer: Any | None = ...,
        name: str | None = ..., how: Literal['blend', 'patches', 'mirror', 'frequency'] | None = ..., width: float |
        None = ..., ramp: Literal['smooth', 'linear'] | None = ..., sigma: float | None = ..., in_low: float | None =
        ..., in_high: float | None = ..., gamma: float | None = ..., out_low: float | None = ..., out_high: float | None
        = ..., points: Any | None = ..., about: Literal['range', 'zero'] | None = ..., low: float | None = ..., high:
        float | None = ..., amount: float | None = ..., factor: float | None = ..., radius: float | None = ..., window:
        Literal['round', 'square'] | None = ..., limit: float | None = ..., side: Literal['below', 'above', 'mean'] |
        None = ..., cells: float | None = ..., octaves: float | None = ..., kind: Literal['perlin', 'gradient', 'value',
        'sheared'] | None = ..., mode: Literal['fbm', 'turbulence', 'billow', 'ridged'] | None = ..., seed: float | None
        = ..., between: Literal['catmull', 'linear'] | None = ...
    ) -> None:
        """Add a filter layer: an operation on the layers below, such as blur or levels."""

    def object(
        self, _form: Literal['add', 'copy', 'choose', 'set', 'hide', 'show', 'remove'], /, *_values: Any, at:
        Sequence[float] | None = ..., size: Sequence[float] | None = ..., hidden: Any | None = ..., still: Any | None =
        ..., turn: Any | None = ..., layer: Any | None = ..., table: Any | None = ..., sha256: str | None = ..., name:
        str | None = ...
    ) -> None:
        """Add, select and change objects of the scene."""

    def ground(
        self, _form: Literal['on', 'off'], /, *, height: float | None = ..., size: float | None = ..., colour:
        Sequence[float] | None = ..., endless: bool | str | None = ...
    ) -> None:
        """Add a floor under the objects."""

    def surface(
        self, _form: Literal['plane', 'bent', 'curl', 'bezier', 'sphere', 'cylinder', 'cone', 'torus', 'cube', 'ribbon',
        'disc', 'capsule', 'superellipsoid', 'revolution', 'formula', 'mesh', 'patches', 'terrain'], /, *, a: float |
        None = ..., b: float | None = ..., endless: float | None = ..., c: Any | None = ..., R: float | None = ..., q:
        float | None = ..., points: Any | None = ..., H: float | None = ..., r: float | None = ..., s: float | None =
        ..., faces: float | None = ..., L: float | None = ..., A: float | None = ..., k: float | None = ..., W: float |
        None = ..., t: float | None = ..., e1: float | None = ..., e2: float | None = ..., profile: Any | None = ..., x:
        Any | None = ..., y: Any | None = ..., z: Any | None = ..., file: Any | None = ..., sha256: str | None = ...,
        projection: Literal['uv', 'planar', 'box', 'cylindrical', 'spherical'] | None = ..., cell: Sequence[float] |
        None = ..., turn: Sequence[float] | None = ..., at: Sequence[float] | None = ..., udim: Any | None = ..., unit:
        Literal['mm', 'cm', 'm', 'in', 'ft', 'um'] | None = ..., origin: Sequence[float] | None = ..., crease: float |
        None = ..., blend: float | None = ..., facing: Literal['any', 'x', 'y', 'z', '-x', '-y', '-z', 'out', 'in'] |
        None = ..., angle: float | None = ..., soft: float | None = ..., materials: Any | None = ..., mask: Any | None =
        ..., table: Literal['each', 'joined', 'split', 'own'] | None = ..., height: float | None = ..., cells: float |
        None = ..., layer: Any | None = ...
    ) -> None:
        """Choose the surface of the object."""

    def model(
        self, *_values: Any
    ) -> None:
        """Use a stock model as the object's surface."""

    def rotate(
        self, *_values: Any, pose: Literal['own'] | None = ...
    ) -> None:
        """Rotate the object."""

    def analytic(
        self, _form: Literal['poly', 'fourier', 'off'], /, *, c: Any | None = ..., terms: Any | None = ...
    ) -> None:
        """Use a formula in place of the table."""

    def bump(
        self, *, mode: Literal['none', 'blinn', 'invariant', 'exact'] | None = ..., scheme: Literal['nearest',
        'bilinear', 'central', 'bspline', 'bspline-fit', 'catmull'] | None = ..., height: float | None = ..., displaced:
        bool | str | None = ..., parallax: bool | str | None = ...
    ) -> None:
        """Set the bump mapping of the object."""

    def replicate(
        self, *_values: Any
    ) -> None:
        """Set how often the table repeats over the surface."""

    def material(
        self, *, preset: Literal['usual', 'clay', 'brick', 'stone', 'wood', 'leather', 'skin', 'plastic', 'porcelain',
        'metal', 'gold', 'copper', 'plaster', 'steel', 'bronze', 'rubber', 'wax', 'ice'] | None = ..., model:
        Literal['blinn-phong', 'phong', 'torrance-sparrow', 'oren-nayar', 'ggx'] | None = ..., energy: Literal['kept',
        'published'] | None = ..., ambient: float | None = ..., diffuse: float | None = ..., specular: float | None =
        ..., shininess: float | None = ..., colour: Sequence[float] | None = ..., gate: bool | str | None = ...,
        roughness: float | None = ..., metalness: float | None = ..., ior: float | None = ..., tint: float | None = ...,
        shadow: bool | str | None = ..., occlusion: bool | str | None = ...
    ) -> None:
        """Set the material of the surface."""

    def grain(
        self, *_values: Any, axis: Literal['x', 'y', 'z'] | None = ..., drives: Literal['colour', 'roughness',
        'colour+roughness', 'bump', 'colour+bump', 'roughness+bump', 'all'] | None = ..., light: Sequence[float] | None
        = ..., dark: Sequence[float] | None = ..., rings: float | None = ..., share: float | None = ..., amount: float |
        None = ..., cells: float | None = ..., octaves: float | None = ..., ratio: float | None = ..., edge: float |
        None = ..., height: float | None = ..., rough_light: float | None = ..., rough_dark: float | None = ...
    ) -> None:
        """Set a solid texture."""

    def colour(
        self, *_values: Any, repeat: Any | None = ..., layer: Any | None = ..., part: Any | None = ..., sha256: str |
        None = ...
    ) -> None:
        """Set a colour picture on the surface."""

    def colouring(
        self, _form: Literal['ramp', 'off'], /, *, stops: Any | None = ..., steep: Sequence[float] | None = ..., slope:
        Sequence[float] | None = ..., cavity: Sequence[float] | None = ..., depth: Sequence[float] | None = ..., within:
        float | None = ..., of: Literal['form', 'table'] | None = ...
    ) -> None:
        """Colour the surface by height, slope and cavity."""

    def normalmap(
        self, *_values: Any, space: Literal['tangent', 'object'] | None = ..., frame: Literal['auto', 'gradient',
        'mikk', 'lecture'] | None = ..., green: Literal['auto', 'up', 'down'] | None = ..., channels: Literal['auto',
        '2', '3'] | None = ..., coding: Literal['auto', 'unit', 'signed'] | None = ..., strength: float | None = ...,
        combine: Literal['slopes', 'reoriented', 'surface'] | None = ..., repeat: Any | None = ..., layer: Any | None =
        ..., part: Any | None = ..., sha256: str | None = ...
    ) -> None:
        """Set a normal map on the surface."""

    def roughness(
        self, *_values: Any, repeat: Any | None = ..., layer: Any | None = ..., part: Any | None = ..., sha256: str |
        None = ...
    ) -> None:
        """Set a roughness map."""

    def metalness(
        self, *_values: Any, repeat: Any | None = ..., layer: Any | None = ..., part: Any | None = ..., sha256: str |
        None = ...
    ) -> None:
        """Set a metalness map."""

    def gltf(
        self, *_values: Any, part: str | None = ..., sha256: str | None = ...
    ) -> None:
        """Use the material of a glTF file."""

    def bake(
        self, *_values: Any, map: Literal['height', 'normal', 'object-normal', 'position', 'occlusion', 'curvature',
        'parts', 'hits'] | None = ..., cage: Any | None = ..., samples: float | None = ..., size: Sequence[int] | None =
        ..., padding: float | None = ..., crease: float | None = ..., match: Literal['all', 'name'] | None = ...,
        sha256: str | None = ...
    ) -> None:
        """Bake relief and other maps of a detailed mesh for the object's mesh."""

    def light(
        self, _form: Literal['directional', 'point', 'clear', 'preset'], /, *_values: Any, to: Sequence[float] | None =
        ..., colour: Sequence[float] | None = ..., strength: float | None = ..., size: float | None = ..., shadow: Any |
        None = ..., index: float | None = ..., at: Sequence[float] | None = ...
    ) -> None:
        """Add, replace or remove lights."""

    def environment(
        self, *_values: Any, turn: float | None = ..., strength: float | None = ..., layer: Any | None = ..., part: Any
        | None = ..., sha256: str | None = ...
    ) -> None:
        """Set the environment, which lights the objects from all sides."""

    def camera(
        self, _form: Literal['perspective', 'orthographic', 'from', 'orbit', 'pan', 'dolly', 'fill', 'save', 'use',
        'forget'], /, *_values: Any, eye: Sequence[float] | None = ..., target: Sequence[float] | None = ..., up:
        Sequence[float] | None = ..., fit: Any | None = ..., frame: float | None = ..., fov: float | None = ..., size:
        float | None = ..., aspect: float | None = ..., turn: Any | None = ..., kind: Literal['perspective',
        'orthographic'] | None = ...
    ) -> None:
        """Set the camera."""

    def background(
        self, _form: Literal['plain', 'gradient', 'none', 'surroundings'], /, *, colour: Sequence[float] | None = ...,
        top: Sequence[float] | None = ..., bottom: Sequence[float] | None = ...
    ) -> None:
        """Set the background behind the objects."""

    def tone(
        self, *_values: Any, exposure: float | None = ..., view: Any | None = ..., display: Any | None = ..., ocio: Any
        | None = ..., space: Any | None = ...
    ) -> None:
        """Set exposure and tone mapping."""

    def cell(
        self, *_values: Any, mm: bool | str | None = ..., height: float | None = ...
    ) -> None:
        """Set the size of the exported cell."""

    def sheet(
        self, *_values: Any, folder: str | PathLike[str] | None = ..., name: str | None = ..., depth: Literal['set',
        '8', '16', '32'] | None = ..., size: Literal['table', 'half', 'quarter', 'power'] | None = ..., range:
        Literal['set', 'auto', 'unit', 'signed'] | None = ...
    ) -> None:
        """Store the settings of the window's export dialog."""

    def dials(
        self, *, aa: Literal['point', 'filter', 'moments', 'supersample', 'adaptive'] | None = ..., samples: float |
        None = ..., spread: Literal['regular', 'jittered'] | None = ..., footprint: Literal['isotropic', 'anisotropic']
        | None = ..., moments: Literal['toksvig', 'lean'] | None = ..., refine: Literal['contrast', 'bound'] | None =
        ..., contrast: float | None = ..., mesh: float | None = ..., newton: float | None = ..., texels: float | None =
        ..., harmonics: float | None = ..., gloss: float | None = ..., faint: float | None = ..., horizons: float | None
        = ..., rays: float | None = ..., dice: float | None = ..., steps: float | None = ..., heights: Literal['double',
        'float', 'half', '16bit', '8bit'] | None = ..., shading: Literal['float', 'double', 'half'] | None = ...,
        arithmetic: Literal['exact', 'fast'] | None = ...
    ) -> None:
        """Set the dials of accuracy and time."""

    def tolerance(
        self, *_values: Any, rms: float | None = ..., max: float | None = ..., time: Any | None = ..., chosen: Any |
        None = ...
    ) -> None:
        """Choose the cheapest dials within an error or a time."""

    def save(
        self, *_values: Any
    ) -> None:
        """Save the document."""

    def copy(
        self, *_values: Any, of: Literal['layer', 'composite'] | None = ...
    ) -> None:
        """Write the selected heights to a file."""

    def export(
        self, _form: Literal['height', 'normal+y', 'normal-y', 'normal-object', 'normal-baked', 'slopes', 'bump-slopes',
        'slope', 'curvature', 'occlusion', 'horizon', 'cavity', 'direction', 'roughness', 'displacement', 'mask',
        'wear', 'packed', 'contact', 'lines', 'profile', 'stl', 'ply', 'obj', '3mf', 'gltf', 'glb'], /, *_values: Any,
        depth: Any | None = ..., range: Any | None = ..., cell: Any | None = ..., scheme: Any | None = ..., dither: Any
        | None = ..., object: str | None = ..., endian: Any | None = ..., sidecar: Any | None = ..., lay: Any | None =
        ..., repeat: Any | None = ..., resize: Any | None = ..., filter: Any | None = ..., atlas: Any | None = ...,
        margin: Any | None = ..., mips: Any | None = ..., border: Any | None = ..., axes: Any | None = ..., strength:
        Any | None = ..., size: Any | None = ..., padding: Any | None = ..., signs: Any | None = ..., uvslopes: Any |
        None = ..., full: Any | None = ..., part: Any | None = ..., directions: Any | None = ..., reach: Any | None =
        ..., toward: Any | None = ..., radius: Any | None = ..., box: Any | None = ..., base: Any | None = ..., ground:
        Any | None = ..., scale: Any | None = ..., low: Any | None = ..., high: Any | None = ..., feather: Any | None =
        ..., threshold: Any | None = ..., noise: Any | None = ..., grain: Any | None = ..., red: Any | None = ...,
        green: Any | None = ..., blue: Any | None = ..., alpha: Any | None = ..., maps: Any | None = ..., tile: Any |
        None = ..., lines: Any | None = ..., view: Any | None = ..., relief: Any | None = ..., pen: Any | None = ...,
        hidden: Any | None = ..., along: Any | None = ..., at: Any | None = ..., grid: Any | None = ..., error: Any |
        None = ..., thickness: Any | None = ..., triangles: Any | None = ..., edges: Any | None = ..., folds: Any | None
        = ...
    ) -> None:
        """Export the table for other programs."""

    def maps(
        self, *_values: Any, depth: Any | None = ..., range: Any | None = ..., cell: Any | None = ..., scheme: Any |
        None = ..., dither: Any | None = ..., object: str | None = ..., endian: Any | None = ..., sidecar: Any | None =
        ..., lay: Any | None = ..., repeat: Any | None = ..., resize: Any | None = ..., filter: Any | None = ..., atlas:
        Any | None = ..., margin: Any | None = ..., mips: Any | None = ..., border: Any | None = ..., axes: Any | None =
        ..., strength: Any | None = ..., size: Any | None = ..., padding: Any | None = ..., signs: Any | None = ...,
        uvslopes: Any | None = ..., full: Any | None = ..., part: Any | None = ..., directions: Any | None = ..., reach:
        Any | None = ..., toward: Any | None = ..., radius: Any | None = ..., box: Any | None = ..., base: Any | None =
        ..., ground: Any | None = ..., scale: Any | None = ..., low: Any | None = ..., high: Any | None = ..., feather:
        Any | None = ..., threshold: Any | None = ..., noise: Any | None = ..., grain: Any | None = ..., red: Any | None
        = ..., green: Any | None = ..., blue: Any | None = ..., alpha: Any | None = ..., maps: Any | None = ..., tile:
        Any | None = ..., lines: Any | None = ..., view: Any | None = ..., relief: Any | None = ..., pen: Any | None =
        ..., hidden: Any | None = ..., along: Any | None = ..., at: Any | None = ..., grid: Any | None = ..., error: Any
        | None = ..., thickness: Any | None = ..., triangles: Any | None = ..., edges: Any | None = ..., folds: Any |
        None = ..., contact: str | None = ..., material: str | None = ..., name: str | None = ..., udim: str | None =
        ...
    ) -> None:
        """Export a set of maps for another program."""

    def bake_tiles(
        self, *_values: Any, map: Literal['height', 'normal', 'object-normal', 'position', 'occlusion', 'curvature',
        'parts', 'hits'] | None = ..., cage: Any | None = ..., samples: float | None = ..., size: Sequence[int] | None =
        ..., padding: float | None = ..., crease: float | None = ..., match: Literal['all', 'name'] | None = ...,
        sha256: str | None = ...
    ) -> None:
        """Bake maps of a detailed mesh, one file for each UDIM tile of the object's mesh."""

    def render(
        self, *_values: Any, size: Sequence[int] | None = ..., turn: float | None = ..., frames: float | None = ...,
        step: float | None = ..., fps: float | None = ..., loop: float | None = ...
    ) -> None:
        """Render a picture of the scene, or a turntable."""

    def script(
        self, *_values: Any, steps: Any | None = ...
    ) -> None:
        """Write the history as a script."""

    def undo(
        self, *_values: Any
    ) -> None:
        """Undo the last commands."""

    def redo(
        self, *_values: Any
    ) -> None:
        """Redo the last undone commands."""

    def step(
        self, _form: Literal['go', 'set', 'off', 'on', 'delete', 'move'], /, *_values: Any, change: Any | None = ...,
        line: Any | None = ..., to: float | None = ...
    ) -> None:
        """Change earlier steps of the history."""

    def view(
        self, _form: Literal['back', 'forward'], /, *_values: Any
    ) -> None:
        """Go back and forward through earlier views."""

    def history(
        self, *, budget: float | None = ...
    ) -> None:
        """Set the memory limit of undo."""
