#include "scene/param.h"

#include "base/enum_rows.h"
#include "scene/scene.h"

#include <string.h>

#define IN_SCENE(member) .place = offsetof(WrScene, member)
#define IN_LIGHT(member) .of_light = true, .place = offsetof(WrLight, member)
#define SLIDER(from, to, digits) .soft_low = (from), .soft_high = (to), .decimals = (digits)
#define GROUND_RANGE                                                                               \
    .components = 3, .high = 1e6, .fallback = { 0.032, 0.032, 0.032 }, .shape = "r,g,b"
#define PLACE_RANGE .components = 3, .low = -1e9, .high = 1e9

/* A vector is three consecutive doubles.
   The table is the single description of a scene's numbers: commands, help, the window's sliders, files and
   interpolation of views all read it. `place` is the member's offset in WrScene or WrLight. components is the
   number of consecutive doubles, 0 a bool; low..high is the accepted range, SLIDER the range that is usual.
   `sparse` members are written to files only where they differ from their fallback, so that old files stay the
   same bytes; `planned` ones may change which effects run. */
_Static_assert(sizeof(WrVec3) == 3 * sizeof(double), "vectors are read as numbers");
_Static_assert(offsetof(WrScene, replicate_v) == offsetof(WrScene, replicate_u) + sizeof(double),
               "the two are read as one pair");
_Static_assert(offsetof(WrScene, cell.h) == offsetof(WrScene, cell.w) + sizeof(double),
               "the two are read as one pair");

WR_ROWS(wr_scene_params);
const WrSceneParam wr_scene_params[WR_SCENE_PARAM_COUNT] = {
    [WR_ROW(WR_SCENE_PARAM_ROTATE)] = { "rotate", NULL, "x,y,z", .positional = true,
                                        IN_SCENE(rotate_deg), PLACE_RANGE, .unit = "degrees",
                                        .help =
                                            "rotation about the world's x, then y, then z axis" },
    [WR_ROW(WR_SCENE_PARAM_HEIGHT)] = { "bump", NULL, "height", IN_SCENE(height), .components = 1,
                                        .low = -1e30, .high = 1e30, .fallback = { 0.1 },
                                        .planned = true, .unit = "scene units", .label = "Height",
                                        .help = "height of the relief where the table is 1",
                                        SLIDER(0, 0.3, 4) },
    [WR_ROW(WR_SCENE_PARAM_DISPLACED)] = { "bump", NULL, "displaced", IN_SCENE(displaced),
                                           .planned = true, .sparse = true,
                                           .help =
                                               "on: true displacement, F moves the surface itself, "
                                               "silhouettes included; off: bump mapping" },
    [WR_ROW(
        WR_SCENE_PARAM_PARALLAX)] = { "bump", NULL, "parallax", IN_SCENE(parallax), .planned = true,
                                      .sparse = true,
                                      .help =
                                          "on: parallax mapping, the relief hides parts of itself; "
                                          "on planes, spheres and cylinders with silhouettes" },
    [WR_ROW(WR_SCENE_PARAM_REPLICATE)] = { "replicate", NULL, "ru,rv", .positional = true,
                                           .required = true, IN_SCENE(replicate_u), .components = 2,
                                           .low = -1e9, .high = 1e9, .fallback = { 1, 1 },
                                           .planned = true, .label = "Repeat u, v",
                                           .help = "repeats of the table along u and v",
                                           SLIDER(1, 16, -1) },
    [WR_ROW(WR_SCENE_PARAM_AMBIENT)] = { "material", NULL, "ambient", IN_SCENE(material.ambient),
                                         .components = 1, .high = 1000, .fallback = { 0.08 },
                                         .label = "Ambient",
                                         .help = "strength of the ambient light (ka)",
                                         SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_DIFFUSE)] = { "material", NULL, "diffuse", IN_SCENE(material.diffuse),
                                         .components = 1, .high = 1000, .fallback = { 0.72 },
                                         .planned = true, .label = "Diffuse",
                                         .help = "strength of the diffuse reflection (kd)",
                                         SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_SPECULAR)] = { "material", NULL, "specular", IN_SCENE(material.specular),
                                          .components = 1, .high = 1000, .fallback = { 0.35 },
                                          .planned = true, .label = "Specular",
                                          .help = "strength of the highlight (ks)",
                                          SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_SHININESS)] = { "material", NULL, "shininess",
                                           IN_SCENE(material.shininess), .components = 1,
                                           .high = 1e6, .fallback = { 40 }, .label = "Shininess",
                                           .help = "exponent of the highlight; higher is smaller",
                                           SLIDER(1, 500, -1), .logarithmic = true },
    [WR_ROW(WR_SCENE_PARAM_MATERIAL_COLOUR)] = { "material", NULL, "colour",
                                                 IN_SCENE(material.colour), .components = 3,
                                                 .high = 1e6, .fallback = { 0.8, 0.8, 0.8 },
                                                 .planned = true, .shape = "r,g,b",
                                                 .label = "Colour",
                                                 .help = "base colour, linear; tint= colours the "
                                                         "highlight with it" },
    [WR_ROW(WR_SCENE_PARAM_GATE)] = { "material", NULL, "gate", IN_SCENE(material.gate),
                                      .fallback = { 1 },
                                      .help =
                                          "on: no highlight where the light is below the surface" },
    [WR_ROW(
        WR_SCENE_PARAM_ROUGHNESS)] = { "material", NULL, "roughness", IN_SCENE(material.roughness),
                                       .components = 1, .high = 1, .fallback = { 0.3 },
                                       .planned = true, .sparse = true, .label = "Roughness",
                                       .help = "0: polished, 1: matt; for oren-nayar the standard "
                                               "deviation of the facets' slopes in radians",
                                       SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_METALNESS)] = { "material", NULL, "metalness",
                                           IN_SCENE(material.metalness), .components = 1, .high = 1,
                                           .planned = true, .sparse = true, .label = "Metalness",
                                           .help = "1: metal, whose highlight has the base colour, "
                                                   "without diffuse reflection",
                                           SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_IOR)] = { "material", NULL, "ior", IN_SCENE(material.ior),
                                     .components = 1, .low = 0.01, .high = 1e4, .fallback = { 1.5 },
                                     .planned = true, .sparse = true, .label = "IOR",
                                     .help = "index of refraction, which sets the reflectance at "
                                             "normal incidence",
                                     SLIDER(1, 4, 3) },
    [WR_ROW(WR_SCENE_PARAM_TINT)] = { "material", NULL, "tint", IN_SCENE(material.tint),
                                      .components = 1, .high = 1, .planned = true, .sparse = true,
                                      .label = "Tint",
                                      .help = "share of the highlight that has the base colour",
                                      SLIDER(0, 1, 2) },
    [WR_ROW(WR_SCENE_PARAM_SHADOW)] = { "material", NULL, "shadow", IN_SCENE(material.shadow),
                                        .planned = true, .sparse = true,
                                        .help = "on: the relief casts shadows on itself" },
    [WR_ROW(WR_SCENE_PARAM_OCCLUSION)] = { "material", NULL, "occlusion",
                                           IN_SCENE(material.occlusion), .planned = true,
                                           .sparse = true,
                                           .help = "on: ambient occlusion, cavities get less light "
                                                   "from the ambient term and the environment" },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_LIGHT)] = { "grain", NULL, "light", IN_SCENE(grain.light),
                                             .components = 3, .high = 1e6, .fallback = { 1, 1, 1 },
                                             .planned = true, .shape = "r,g,b", .label = "Light",
                                             .help = "light colour of the pattern, linear; "
                                                     "multiplies the base colour" },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_DARK)] = { "grain", NULL, "dark", IN_SCENE(grain.dark),
                                            .components = 3, .high = 1e6, .fallback = { 0, 0, 0 },
                                            .planned = true, .shape = "r,g,b", .label = "Dark",
                                            .help = "dark colour of the pattern, linear; "
                                                    "multiplies the base colour" },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_RINGS)] = { "grain", NULL, "rings", IN_SCENE(grain.rings),
                                             .components = 1, .high = 1e6, .fallback = { 8 },
                                             .label = "Rings", .unit = "a scene unit",
                                             .help = "rings of wood, bands of marble, squares of a "
                                                     "checkerboard",
                                             SLIDER(0.5, 60, 2), .logarithmic = true },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_SHARE)] = { "grain", NULL, "share", IN_SCENE(grain.share),
                                             .components = 1, .high = 1, .fallback = { 0.5 },
                                             .label = "Dark part",
                                             .help = "dark share of each ring of wood",
                                             SLIDER(0, 1, 2) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_AMOUNT)] = { "grain", NULL, "amount", IN_SCENE(grain.amount),
                                              .components = 1, .low = -1e6, .high = 1e6,
                                              .fallback = { 0.5 }, .planned = true,
                                              .label = "Noise",
                                              .help = "distortion of the rings by noise, in rings; "
                                                      "of granite and noise their contrast",
                                              SLIDER(0, 4, 2) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_CELLS)] = { "grain", NULL, "cells", IN_SCENE(grain.cells),
                                             .components = 1, .low = 1e-3, .high = 1e4,
                                             .fallback = { 2 }, .label = "Noise scale",
                                             .unit = "a scene unit",
                                             .help = "cells of the noise: more are finer",
                                             SLIDER(0.2, 40, 2), .logarithmic = true },
    [WR_ROW(
        WR_SCENE_PARAM_GRAIN_OCTAVES)] = { "grain", NULL, "octaves", IN_SCENE(grain.octaves),
                                           .components = 1, .low = 1, .high = 10, .fallback = { 3 },
                                           .label = "Octaves",
                                           .help = "octaves of noise, each twice as fine as the "
                                                   "one before; rounded",
                                           SLIDER(1, 10, 0) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_RATIO)] = { "grain", NULL, "ratio", IN_SCENE(grain.ratio),
                                             .components = 1, .low = 1.01, .high = 100,
                                             .fallback = { 2 }, .label = "Falloff of octaves",
                                             .help = "amplitude ratio of successive octaves; "
                                                     "higher is smoother",
                                             SLIDER(1.1, 4, 2) },
    [WR_ROW(
        WR_SCENE_PARAM_GRAIN_EDGE)] = { "grain", NULL, "edge", IN_SCENE(grain.edge),
                                        .components = 1, .high = 1, .sparse = true, .label = "Edge",
                                        .help =
                                            "softness of the edges of wood and checkerboard, as a "
                                            "share of a ring or square; bumps use 1/16 or more",
                                        SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_HEIGHT)] = { "grain", NULL, "height", IN_SCENE(grain.height),
                                              .components = 1, .low = -1e6, .high = 1e6,
                                              .fallback = { 0.01 }, .planned = true, .sparse = true,
                                              .unit = "scene units", .label = "Height",
                                              .help = "height of the dark parts above the light "
                                                      "ones, if it drives bump",
                                              SLIDER(-0.1, 0.1, 3) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_ROUGH_LIGHT)] = { "grain", NULL, "rough_light",
                                                   IN_SCENE(grain.roughness[0]), .components = 1,
                                                   .high = 1, .fallback = { 0.3 }, .sparse = true,
                                                   .label = "Light roughness",
                                                   .help = "roughness of the light parts, if it "
                                                           "drives roughness",
                                                   SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_GRAIN_ROUGH_DARK)] = { "grain", NULL, "rough_dark",
                                                  IN_SCENE(grain.roughness[1]), .components = 1,
                                                  .high = 1, .fallback = { 0.5 }, .sparse = true,
                                                  .label = "Dark roughness",
                                                  .help = "roughness of the dark parts, if it "
                                                          "drives roughness",
                                                  SLIDER(0, 1, 3) },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_TO)] = { "light", "directional", "to", .required = true,
                                          IN_LIGHT(where), PLACE_RANGE,
                                          .fallback = { -0.5, 0.6, 0.75 },
                                          .help = "direction from the surface to the light, of any "
                                                  "length" },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_AT)] = { "light", "point", "at", .required = true, IN_LIGHT(where),
                                          PLACE_RANGE, .fallback = { -0.5, 0.6, 0.75 },
                                          .unit = "scene units", .help = "position of the light" },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_COLOUR)] = { "light", NULL, "colour", .filled = true,
                                              IN_LIGHT(colour), .components = 3, .high = 1e6,
                                              .fallback = { 1, 1, 1 }, .planned = true,
                                              .shape = "r,g,b", .label = "Colour",
                                              .help = "linear" },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_STRENGTH)] = { "light", NULL, "strength", .filled = true,
                                                IN_LIGHT(strength), .components = 1, .high = 1e6,
                                                .fallback = { 1 }, .planned = true,
                                                .label = "Strength",
                                                .help = "intensity: multiplies the colour",
                                                SLIDER(0, 2, 2) },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_SIZE)] = { "light", NULL, "size", .filled = true,
                                            IN_LIGHT(size_deg), .components = 1, .high = 45,
                                            .sparse = true, .unit = "degrees", .label = "Softness",
                                            .help = "angular radius of a disc light, which softens "
                                                    "shadows; the sun has 0.27",
                                            SLIDER(0, 10, 2) },
    [WR_ROW(WR_SCENE_PARAM_LIGHT_SHADOW)] = { "light", NULL, "shadow", .filled = true,
                                              IN_LIGHT(shadow), .planned = true, .sparse = true,
                                              .label = "Shadows of objects",
                                              .help = "on: objects cast shadows in this light, on "
                                                      "each other and on themselves" },
    [WR_ROW(WR_SCENE_PARAM_ENVIRONMENT_TURN)] = { "environment", NULL, "turn",
                                                  IN_SCENE(environment.turn_deg), .components = 1,
                                                  .low = -1e9, .high = 1e9, .unit = "degrees",
                                                  .label = "Turn",
                                                  .help = "rotation of the environment about the "
                                                          "vertical axis",
                                                  SLIDER(-180, 180, 1) },
    [WR_ROW(WR_SCENE_PARAM_ENVIRONMENT_STRENGTH)] = { "environment", NULL, "strength",
                                                      IN_SCENE(environment.strength),
                                                      .components = 1, .high = 1e6,
                                                      .fallback = { 1 }, .planned = true,
                                                      .label = "Strength",
                                                      .help = "intensity of the environment",
                                                      SLIDER(0, 2, 2) },
    [WR_ROW(WR_SCENE_PARAM_EYE)] = { "camera", NULL, "eye", IN_SCENE(camera.eye), PLACE_RANGE,
                                     .fallback = { 0, 0, 1 }, .planned = true,
                                     .unit = "scene units", .help = "position of the camera" },
    [WR_ROW(WR_SCENE_PARAM_TARGET)] = { "camera", NULL, "target", IN_SCENE(camera.target),
                                        PLACE_RANGE, .unit = "scene units",
                                        .help = "point at the centre of the view" },
    [WR_ROW(WR_SCENE_PARAM_UP)] = { "camera", NULL, "up", IN_SCENE(camera.up), PLACE_RANGE,
                                    .fallback = { 0, 1, 0 },
                                    .help = "upward direction of the picture" },
    [WR_ROW(WR_SCENE_PARAM_FIT)] = { "camera", NULL, "fit", IN_SCENE(camera.fit), .fallback = { 1 },
                                     .planned = true,
                                     .help = "on: the camera's distance is chosen so that the "
                                             "objects just fit; eye= switches it off" },
    [WR_ROW(WR_SCENE_PARAM_FRAME)] = { "camera", NULL, "frame", IN_SCENE(camera.frame),
                                       .components = 1, .sparse = true, .high = 1e4,
                                       .fallback = { 0 },
                                       .help = "aspect ratio that must stay visible: a narrower "
                                               "picture shows the same width and more height; 0: "
                                               "none; without fit=on" },
    [WR_ROW(WR_SCENE_PARAM_FOV)] = { "camera", "perspective", "fov", IN_SCENE(camera.fov_deg),
                                     .components = 1, .low = 0.01, .high = 179, .fallback = { 35 },
                                     .unit = "degrees", .label = "Angle",
                                     .help = "vertical angle of view", SLIDER(5, 120, 1) },
    [WR_ROW(
        WR_SCENE_PARAM_CAMERA_SIZE)] = { "camera", "orthographic", "size", IN_SCENE(camera.size),
                                         .components = 1, .high = 1e9, .unit = "scene units",
                                         .help = "height of the view; 0: the objects just fit" },
    [WR_ROW(WR_SCENE_PARAM_AT)] = { "object", "set", "at", IN_SCENE(at), PLACE_RANGE,
                                    .planned = true, .unit = "scene units", .label = "Position",
                                    .help = "position of its centre in the world" },
    [WR_ROW(WR_SCENE_PARAM_SIZE)] = { "object", "set", "size", IN_SCENE(size), .components = 1,
                                      .planned = true, .low = 1e-9, .high = 1e9, .fallback = { 1 },
                                      .label = "Size",
                                      .help = "scale of the object; heights scale with it",
                                      SLIDER(0.1, 4, 3), .logarithmic = true },
    [WR_ROW(WR_SCENE_PARAM_HIDDEN)] = { "object", "set", "hidden", IN_SCENE(hidden),
                                        .planned = true, .help = "on: the object is not rendered" },
    [WR_ROW(WR_SCENE_PARAM_STILL)] = { "object", "set", "still", IN_SCENE(still),
                                       .help = "on: not rotated by the turntable, and ignored when "
                                               "the camera fits the objects" },
    [WR_ROW(WR_SCENE_PARAM_BACKGROUND)] = { "background", "plain", "colour",
                                            IN_SCENE(background.top), GROUND_RANGE,
                                            .label = "Colour", .help = "linear" },
    [WR_ROW(WR_SCENE_PARAM_BACKGROUND_TOP)] = { "background", "gradient", "top",
                                                IN_SCENE(background.top), GROUND_RANGE,
                                                .label = "Top",
                                                .help = "colour at the upper border, linear" },
    [WR_ROW(WR_SCENE_PARAM_BACKGROUND_BOTTOM)] = { "background", "gradient", "bottom",
                                                   IN_SCENE(background.bottom), GROUND_RANGE,
                                                   .label = "Bottom",
                                                   .help = "colour at the lower border, linear" },
    [WR_ROW(WR_SCENE_PARAM_EXPOSURE)] = { "tone", NULL, "exposure", IN_SCENE(tone.exposure),
                                          .components = 1, .low = -20, .high = 20, .unit = "stops",
                                          .label = "Exposure",
                                          .help = "exposure; each stop doubles the light",
                                          SLIDER(-4, 4, 2) },
    [WR_ROW(WR_SCENE_PARAM_CELL_SIZE)] = { "cell", NULL, "WIDTH,HEIGHT", .positional = true,
                                           IN_SCENE(cell.w), .components = 2, .low = 1e-9,
                                           .high = 1e9, .fallback = { 1, 1 }, .label = "Cell",
                                           .help = "width and height of the cell",
                                           SLIDER(0.1, 1000, -1), .logarithmic = true },
    [WR_ROW(WR_SCENE_PARAM_CELL_MM)] = { "cell", NULL, "mm", IN_SCENE(cell.mm),
                                         .help = "on: the size is in millimetres; off: in scene "
                                                 "units" },
    [WR_ROW(WR_SCENE_PARAM_CELL_HEIGHT)] = { "cell", NULL, "height", IN_SCENE(cell.height),
                                             .components = 1, .low = 1e-9, .high = 1e9,
                                             .fallback = { 1 }, .unit = "mm",
                                             .label = "Full height",
                                             .help = "height where the table is 1, in mm",
                                             SLIDER(0.01, 100, -1), .logarithmic = true },
};
WR_ROWS_END(wr_scene_params, WR_SCENE_PARAM_COUNT);

/* Rows with a form (light directional / point) are alternatives: form NULL passes all. */
const WrSceneParam *wr_scene_param(const char *command, const char *form, int i)
{
    for (int k = 0; k < WR_SCENE_PARAM_COUNT; k++) {
        const WrSceneParam *p = &wr_scene_params[k];
        if (strcmp(p->command, command) != 0) continue;
        if (form && p->form && strcmp(p->form, form) != 0) continue;
        if (i-- == 0) return p;
    }
    return NULL;
}

void wr_scene_param_get(const WrSceneParam *param, const void *owner, double *values)
{
    const char *at = (const char *)owner + param->place;
    if (param->components == 0) values[0] = *(const bool *)at ? 1 : 0;
    else memcpy(values, at, (size_t)param->components * sizeof *values);
}

void wr_scene_param_set(const WrSceneParam *param, void *owner, const double *values)
{
    char *at = (char *)owner + param->place;
    if (param->components == 0) *(bool *)at = values[0] != 0;
    else memcpy(at, values, (size_t)param->components * sizeof *values);
}

/* Runs on zeroed memory too: each member of the table has its fallback afterwards; members outside of it are
   untouched. */
void wr_scene_params_reset(void *owner, bool of_light)
{
    for (int k = 0; k < WR_SCENE_PARAM_COUNT; k++)
        if (wr_scene_params[k].of_light == of_light)
            wr_scene_param_set(&wr_scene_params[k], owner, wr_scene_params[k].fallback);
}
