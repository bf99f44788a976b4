/* Rows of the hard cases of the second part: HC156 on. */
#include "hardcases/hardcases_later.h"

#define ROW(number, about, situation, rule, u, in_float, in_double, script)                        \
    {                                                                                              \
        .id = "HC" #number, .subject = about, .what = situation, .holds = rule, .unit = u,         \
        .bound = { in_float, in_double }, .measure = wr_hard_hc##number, .scene = script           \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    ROW(156, WR_HARD_GEOMETRY, "control points that fall together",
        "n at the corner is that beside it, perturbed normals are unit, no picture holds a NaN",
        "violations", 0, 0,
        WAVES "surface bezier points=0,0,0;0,0,0;0.667,0,0.164;1,0,0.37;0,0.333,0.041;"
              "0.333,0.333,0.082;0.667,0.333,0.206;1,0.333,0.411;0,0.667,0.164;0.333,0.667,0.206;"
              "0.667,0.667,0.329;1,0.667,0.534;0,1,0.37;0.333,1,0.411;0.667,1,0.534;1,1,0.74\n"
              "bump height=0.02"),
    ROW(157, WR_HARD_TABLE, "a table of one row or column, as a picture",
        "that of the table which says the same in eight rows or columns", "violations", 0, 0,
        "table 1x24\ndab 0.5,0.5 radius=3 strength=1\nsurface sphere\nbump height=0.3"),
    ROW(158, WR_HARD_RENDER, "an eye at the very middle of a body, and a hair under its skin",
        "the inside as the reference has it, in float, fast and double", "of pixels", 0.02, 0.02,
        WAVES "surface sphere\nrotate 0,0,0\nbump height=0.02\nlight point at=0.1,0.1,0.1\n"
              "camera perspective eye=0,0,0 target=1,0.3,0.2 up=0,0,1 fov=70"),
    ROW(159, WR_HARD_RENDER, "a lamp on the surface",
        "the place that it touches has a number for its light, within what the lamp can give",
        "violations", 0, 0,
        WAVES "surface sphere\nrotate 0,0,0\nbump height=0.05\nlight point at=-1,0,0\n"
              "camera orthographic eye=-3,0,0.1 target=-1,0,0 up=0,0,1 size=1"),
    ROW(160, WR_HARD_GEOMETRY, "a torus whose hole is one point, R = r",
        "n points away from the tube's centre line beside it too; perturbed normals are unit",
        "rad", 1e-6, 1e-14, WAVES "surface torus R=0.5 r=0.5\nrotate -60,0,0\nbump height=0.05"),
    ROW(161, WR_HARD_GEOMETRY, "surfaces of next to no area, sides of 1e-30",
        "perturbed normals are unit and no picture holds a NaN", "violations", 0, 0,
        WAVES "surface cylinder R=0.8 H=1e-30\nbump height=0.1"),
    ROW(162, WR_HARD_PAINT, "layers that all but cancel",
        "what is left is the exact difference of the stored heights", "violations", 0, NAN,
        "table 32x32\nfill 1e6\nlayer add less\nfill 999999.9\nlayer set less blend=subtract\n"
        "surface plane"),
    ROW(163, WR_HARD_RENDER, "a million repeats, whole and broken, under the moments of slopes",
        "far more texels than pixels: the mean slope, which is none, not noise", "intensity", 0.02,
        NAN,
        WAVES "surface plane\nreplicate 1e6,333333.3\nbump height=1e-8\n"
              "dials aa=moments moments=lean"),
    ROW(164, WR_HARD_RENDER, "a ribbon twisted by sixty turns",
        "coverage and light as the reference has them, under supersampling", "of pixels", 0.02,
        0.02, WAVES "surface ribbon t=60\nbump height=0.002\ndials aa=supersample samples=4"),
    ROW(165, WR_HARD_PAINT, "edits of heights at float's ends",
        "every operation leaves numbers: too large ones are clamped", "violations", 0, NAN,
        "table 33x20\nfill 3.4e38\nadjust multiply factor=2\nadjust blur sigma=3\nsurface plane"),
    ROW(166, WR_HARD_RENDER, "light from all but behind the surface, down to 1e-9 of opposite",
        "the highlight is within 0..1, and as right as the half vector's own digits",
        "of what they leave", 0.1, 1,
        WAVES "surface plane\nbump height=0.02\nmaterial specular=1 gate=off\n"
              "light directional to=1e-5,0,-1"),
    ROW(167, WR_HARD_RENDER, "a window of a millionth upon the cone's tip",
        "every pixel is the cone, in float, fast and double", "violations", 0, 0,
        WAVES "surface cone\nrotate 0,0,0\nbump height=0.001\n"
              "camera orthographic eye=0,0,5 target=0,0,0 up=0,1,0 size=1e-5"),
    ROW(168, WR_HARD_RENDER, "ground of 2e5 units under an eye 0.5 above it",
        "seen down to one's feet: as the reference has it, by closed form and by cells",
        "of pixels", 0.01, 0.01,
        WAVES "surface plane a=200000 b=200000\nrotate 0,0,0\nreplicate 200000,200000\n"
              "bump height=0.05\n"
              "camera perspective eye=0,0,0.5 target=0,0.5,0 up=0,0,1 fov=120"),
    ROW(169, WR_HARD_GEOMETRY, "the seam of closed surfaces, reached from both sides and as -0",
        "u is within 0..1, 1 left out, and 0 on the seam", "violations", 0, 0,
        WAVES "surface cylinder\nrotate -90,0,-90\nbump height=0.05"),
    ROW(170, WR_HARD_RENDER, "an eye ten thousand radii away", "the picture of parallel rays",
        "of pixels", 0.005, 0.005,
        WAVES "surface torus\nrotate 30,0,0\nbump height=0.02\n"
              "camera perspective eye=0,0,17000 target=0,0,0 up=0,1,0 fov=0.01"),
    ROW(171, WR_HARD_RENDER, "rays along the cube's edges and through its corners",
        "no background within the outline", "violations", 0, 0,
        WAVES "surface cube\nrotate 0,0,0\nbump height=0.02\n"
              "camera orthographic eye=3,3,3 target=0,0,0 up=0,0,1 size=2.5"),
    ROW(172, WR_HARD_RENDER, "a camera whose up lies along its view, or all but",
        "its axes stand upright on each other and no picture holds a NaN", "of 1", NAN, 1e-12,
        WAVES "surface torus\nrotate 0,0,0\nbump height=0.05\n"
              "camera perspective eye=0,0,5 target=0,0,0 up=0,0,1"),
    ROW(173, WR_HARD_TABLE, "+0 and -0 in one table", "the picture of a level table, to the bit",
        "violations", 0, 0, "table 24x24\nfill 0\nsurface torus\nbump mode=exact height=-1e30"),
    ROW(174, WR_HARD_RENDER, "the seam and the poles under filters",
        "the seam does not show: the picture of the table rolled by half, turned by half a turn",
        "intensity", 1e-3, NAN,
        WAVES "surface cylinder\nrotate -90,0,0\nbump height=0.03\n"
              "dials aa=moments footprint=anisotropic"),
    ROW(175, WR_HARD_TABLE, "heights of 1e30 that the scene makes 1e300 times as high",
        "no picture holds a NaN", "violations", 0, 0,
        WAVES "adjust multiply factor=1e30\nsurface torus\nbump mode=exact height=1e30"),
    ROW(176, WR_HARD_TABLE, "a cube's face beside cells of one table that are higher",
        "what lies in other cells does not show, to the bit, by look-ups and by filters",
        "violations", 0, 0,
        "table 192x128\nnoise perlin cells=8\nsurface cube faces=6\nbump height=0.05"),
    ROW(177, WR_HARD_GEOMETRY, "ground of layers: level, rising, of one texel, as high as a float",
        "level ground is level, rising ground rises as evenly; heights stay numbers",
        "of the height", NAN, 1e-6,
        "table 33x20\nlayer add form\nfill 0.4\nsurface terrain layer=form"),
    ROW(178, WR_HARD_TABLE, "colours by height: two stops at one height, a step of slope, cliffs",
        "a step where told, straight between, even beyond; no NaN; the seam does not show",
        "violations", 0, 0, "table 64x64\nnoise perlin cells=8\nsurface plane\ncolouring ramp"),
    ROW(179, WR_HARD_RENDER, "ground without end: from below, along it, upon it, from far away",
        "numbers, and the coverage and light that the reference has", "of pixels", 0.01, 0.01,
        WAVES "surface plane endless=1\nrotate -90,0,0\nbump height=0.02\n"
              "camera perspective eye=0,-0.4,2 target=0,-0.2,0 up=0,1,0 fov=60"),
};
WR_HARD_LIST(later, rows);
