#include "base/error.h"
#include "field/scheme_list.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "export/contact_sheet.h"
#include "export/job.h"
#include "export/line_drawing.h"
#include "export/option_parsers.h"
#include "export/channel_packing.h"
#include "field/scheme.h"

#include <math.h>
#include <string.h>

static bool set_depth(WrExportOptions *options, const char *value, WrError *err)
{
    double depth;
    if (!wr_number_parse(value, strlen(value), &depth) ||
        (depth != 8 && depth != 16 && depth != 32))
        return wr_fail(err, "depth '%.40s': must be 8, 16 or 32", value);
    options->depth = (int)depth;
    return true;
}

/* "A,B" */
static bool parse_pair(const char *value, double *a, double *b)
{
    const char *comma = strchr(value, ',');
    return comma && wr_number_parse(value, (size_t)(comma - value), a) &&
           wr_number_parse(comma + 1, strlen(comma + 1), b);
}

static bool set_range(WrExportOptions *options, const char *value, WrError *err)
{
    double low, high;
    if (strcmp(value, "auto") == 0) {
        options->range = WR_EXPORT_RANGE_AUTO;
    } else if (strcmp(value, "signed") == 0) {
        options->range = WR_EXPORT_RANGE_SIGNED;
    } else if (parse_pair(value, &low, &high) && low < high) {
        options->range = WR_EXPORT_RANGE_GIVEN;
        options->low = low;
        options->high = high;
    } else {
        return wr_fail(err, "range '%.80s': must be LOW,HIGH with LOW below HIGH, auto or signed",
                       value);
    }
    return true;
}

static bool set_cell(WrExportOptions *options, const char *value, WrError *err)
{
    double w, h;
    if (!parse_pair(value, &w, &h) || !(w > 0.0) || !(h > 0.0))
        return wr_fail(err, "cell '%.80s': must be WIDTH,HEIGHT, both above 0", value);
    options->cell_w = w;
    options->cell_h = h;
    return true;
}

static const char *scheme_name(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_SCHEME_COUNT ? wr_schemes[i].name : NULL;
}

static bool set_scheme(WrExportOptions *options, const char *value, WrError *err)
{
    int scheme = wr_scheme_find(value);
    if (scheme >= 0) {
        options->scheme = scheme;
        return true;
    }
    char what[80];
    snprintf(what, sizeof what, "scheme '%.40s'", value);
    return wr_fail_word(err, what, value, scheme_name, NULL);
}

/* Whether an object of that name exists is checked by the export. */
static bool set_object(WrExportOptions *options, const char *value, WrError *err)
{
    if (!*value) return wr_fail(err, "object: must be the name of one of the scene's objects");
    options->object = value;
    return true;
}

static bool set_lines(WrExportOptions *options, const char *value, WrError *err)
{
    int u, v;
    if (!wr_export_parse_size(value, 0, WR_LINES_MAX, &u, &v) || u + v == 0)
        return wr_fail(err, "lines '%.40s': must be MxN, lines along u and along v, 0..%d each",
                       value, WR_LINES_MAX);
    options->lines_u = u;
    options->lines_v = v;
    return true;
}

static bool set_size(WrExportOptions *options, const char *value, WrError *err)
{
    if (!wr_export_parse_size(value, 16, WR_DRAWING_MAX, &options->drawing_w, &options->drawing_h))
        return wr_fail(err, "size '%.40s': must be WIDTHxHEIGHT in pixels, 16..%d each", value,
                       WR_DRAWING_MAX);
    return true;
}

static bool set_view(WrExportOptions *options, const char *value, WrError *err)
{
    double turn, tilt;
    if (!parse_pair(value, &turn, &tilt) || fabs(turn) > 360.0 || tilt < 0.0 || tilt > 90.0)
        return wr_fail(err, "view '%.80s': must be TURN,TILT in degrees, -360..360 and 0..90",
                       value);
    options->turn_deg = turn;
    options->tilt_deg = tilt;
    return true;
}

static bool set_relief(WrExportOptions *options, const char *value, WrError *err)
{
    double relief = 0.0;
    if (strcmp(value, "auto") != 0 && (!wr_number_parse(value, strlen(value), &relief) ||
                                       !(fabs(relief) <= 1e6) || relief == 0.0))
        return wr_fail(err, "relief '%.40s': must be the height of F = 1 in cells, or auto", value);
    options->relief = relief;
    return true;
}

static bool set_pen(WrExportOptions *options, const char *value, WrError *err)
{
    double pen;
    if (!wr_number_parse(value, strlen(value), &pen) || !(pen >= 0.1 && pen <= 20.0))
        return wr_fail(err, "pen '%.40s': must be the line width in pixels, 0.1..20", value);
    options->pen = pen;
    return true;
}

static bool set_along(WrExportOptions *options, const char *value, WrError *err)
{
    bool v = strcmp(value, "v") == 0;
    if (!v && strcmp(value, "u") != 0) return wr_fail(err, "along '%.40s': must be u or v", value);
    options->along_v = v;
    return true;
}

static bool set_at(WrExportOptions *options, const char *value, WrError *err)
{
    double at;
    if (!wr_number_parse(value, strlen(value), &at) || !(at >= 0.0 && at <= 1.0))
        return wr_fail(err, "at '%.40s': must be the other coordinate, 0..1", value);
    options->at = at;
    return true;
}

static bool set_grid(WrExportOptions *options, const char *value, WrError *err)
{
    double grid;
    if (!wr_number_parse(value, strlen(value), &grid) || grid != floor(grid) ||
        !(grid >= 1.0 && grid <= 256.0))
        return wr_fail(err, "grid '%.40s': must be a whole number of divisions, 1..256", value);
    options->grid = (int)grid;
    return true;
}

#define DEPTH                                                                                      \
    {                                                                                              \
        "depth", "8, 16 or 32",                                                                    \
            "bits per channel; 32 is float, and so is 16 in exr; left out: the deepest of the "    \
            "file format",                                                                         \
            set_depth                                                                              \
    }
#define FLOATS                                                                                     \
    {                                                                                              \
        "depth", "16 or 32", "bits per channel; 16: half floats, only in exr; left out: 32",       \
            set_depth                                                                              \
    }
#define RANGE                                                                                      \
    {                                                                                              \
        "range", "LOW,HIGH, auto or signed",                                                       \
            "heights of the first and last code, beyond which they are clipped; auto: the "        \
            "table's range; signed: 0 exactly in the middle; left out: auto. Float files store "   \
            "unchanged heights",                                                                   \
            set_range                                                                              \
    }
#define CELL                                                                                       \
    {                                                                                              \
        "cell", "WIDTH,HEIGHT", "size of the unit cell; left out: the document's (`cell`)",        \
            set_cell                                                                               \
    }
#define SCHEME                                                                                     \
    {                                                                                              \
        "scheme", "a derivative scheme", "left out: the scene's", set_scheme                       \
    }
#define DITHER                                                                                     \
    {                                                                                              \
        "dither", "on or off", "dithers 8-bit files to hide steps; left out: off",                 \
            wr_export_set_dither                                                                   \
    }

#define OBJECT                                                                                     \
    {                                                                                              \
        "object", "NAME", "the table of this object; left out: the composite of all layers",       \
            set_object, true                                                                       \
    }

#define BODY                                                                                       \
    {                                                                                              \
        "object", "NAME", "this object; left out: the active one, with its own table", set_object, \
            true                                                                                   \
    }

#define MAP_SIZE                                                                                   \
    {                                                                                              \
        "size", "WIDTHxHEIGHT", "size of the map in texels; left out: the table's",                \
            wr_export_set_map_size                                                                 \
    }

#define AXES                                                                                       \
    {                                                                                              \
        "axes", "+x+y+z, opengl or directx",                                                       \
            "axes in red, green and blue, in any order with any signs; left out: as the name "     \
            "says",                                                                                \
            wr_export_set_axes                                                                     \
    }

#define NORMAL_OPTIONS                                                                             \
    {                                                                                              \
        DEPTH, CELL, SCHEME, DITHER, OBJECT, AXES,                                                 \
            { "strength", "FACTOR", "factor of the slopes; left out: 1", wr_export_set_strength }, \
            WR_OPTION_ENDIAN, WR_OPTION_SIDECAR, WR_OPTION_SHEET, WR_OPTION_MIPS, WR_OPTION_BORDER \
    }

#define SOLID_OPTIONS                                                                              \
    {                                                                                              \
        { "size", "MM",                                                                            \
          "longest side of the surface without its relief; left out: for a plane by `cell "        \
          "mm=on`, for a mesh by the unit of its file, else 100",                                  \
          wr_export_set_solid_size },                                                              \
            { "error", "MM", "largest distance of a texel from its triangle; left out: 0.05",      \
              wr_export_set_solid_error },                                                         \
            { "thickness", "MM",                                                                   \
              "thickness under the lowest texel; left out: 2 for a sheet; a tube is solid",        \
              wr_export_set_thickness },                                                           \
            { "triangles", "COUNT", "largest number, without the back; left out: 4000000",         \
              wr_export_set_triangles },                                                           \
            { "edges", "sharp or round",                                                           \
              "for a mesh: hard edges under relief stay sharp or become round; left out: sharp",   \
              wr_export_set_edges },                                                               \
            { "folds", "keep or limit",                                                            \
              "for a mesh: relief that overlaps itself is kept or lowered; left out: keep",        \
              wr_export_set_folds },                                                               \
            BODY                                                                                   \
    }

static const char *const slope_names[] = { "dF_du", "dF_dv" };
static const char *const bump_slope_names[] = { "b0_h",     "b1_dhds",  "b2_dhdt",
                                                "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt" };

/* Order is that of menus, help and contact sheets. Each row has one of three writers: `rows` produces pixels of the table row
   by row in parallel; `make` first computes a map of the whole table as floats (job->map), which `rows` = wr_export_map_rows
   then encodes; `write` writes the whole file itself. green: sign of the green axis of normals, 0 for other kinds.
   on_surface: positions are (u,v) of the surface, so heights keep the scene's unit and `size` may differ from the table's. */
const WrExportKind wr_export_kinds[] = {
    { .name = "height",
      .label = "height",
      .help = "the table itself: one channel, white is high",
      .options = { DEPTH, RANGE, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_ENDIAN, WR_OPTION_SIDECAR,
                   WR_OPTION_SHEET, WR_OPTION_MIPS, WR_OPTION_BORDER },
      .role = WR_ROLE_HEIGHT,
      .table_units = true,
      .channels = 1,
      .prepare = wr_export_height_prepare,
      .rows = wr_export_height_rows,
      .describe = wr_export_height_describe },
    { .name = "normal+y",
      .label = "normal map, +Y (OpenGL)",
      .help = "unit normals with green up: glTF, Blender, Godot, Unity, Maya",
      .options = NORMAL_OPTIONS,
      .channels = 3,
      .green = 1.0,
      .rows = wr_export_normal_rows,
      .describe = wr_export_normal_describe },
    { .name = "normal-y",
      .label = "normal map, -Y (DirectX)",
      .help = "unit normals with green down: Unreal, 3ds Max, Source",
      .options = NORMAL_OPTIONS,
      .channels = 3,
      .green = -1.0,
      .rows = wr_export_normal_rows,
      .describe = wr_export_normal_describe },
    { .name = "normal-object",
      .label = "normal map along the object's axes",
      .help = "normals in the object's own axes, bump included: valid for this object only",
      .options = { DEPTH, DITHER, OBJECT, AXES, MAP_SIZE },
      .channels = 3,
      .green = 1.0,
      .on_surface = true,
      .rows = wr_export_object_rows,
      .describe = wr_export_object_describe },
    { .name = "normal-baked",
      .label = "normal map baked for the mesh",
      .help = "normals of the mesh with bump and normal map, in tangent frames of MikkTSpace: "
              "Blender, Unreal, Unity, Godot, glTF",
      .options = { DEPTH,
                   DITHER,
                   OBJECT,
                   AXES,
                   MAP_SIZE,
                   { "padding", "TEXELS", "margin around the islands of (u,v), 0..64; left out: 8",
                     wr_export_set_padding } },
      .channels = 3,
      .green = 1.0,
      .on_surface = true,
      .make = wr_export_baked_make,
      .rows = wr_export_baked_rows,
      .describe = wr_export_baked_describe },
    { .name = "slopes",
      .label = "slopes",
      .help = "dF/du and dF/dv as two channels of floats, in scene units: exr or tiff",
      .options = { FLOATS, CELL, SCHEME, OBJECT, WR_OPTION_ENDIAN, WR_OPTION_SIDECAR,
                   WR_OPTION_SHEET, WR_OPTION_MIPS, WR_OPTION_BORDER },
      .channels = 2,
      .floats = true,
      .channel_names = slope_names,
      .rows = wr_export_slopes_rows,
      .describe = wr_export_derived_describe },
    { .name = "bump-slopes",
      .label = "bump slopes",
      .help = "height, slopes and their products on every mip level of a tiled exr, for filtered "
              "textures: OpenImageIO, RenderMan, Arnold",
      .options = { FLOATS,
                   SCHEME,
                   { "signs", "plain or renderman",
                     "renderman: negated slopes, as by txmake; left out: plain",
                     wr_export_set_signs },
                   { "uvslopes", "DIVISOR",
                     "slopes per whole cell, divided by this; left out: 0, slopes per texel",
                     wr_export_set_uvslopes },
                   OBJECT,
                   WR_OPTION_SIDECAR,
                   WR_OPTION_SHEET },
      .channels = 6,
      .floats = true,
      .levels = true,
      .channel_names = bump_slope_names,
      .ending = "exr",
      .rows = wr_export_bump_slopes_rows,
      .describe = wr_export_bump_slopes_describe },
    { .name = "slope",
      .label = "steepness",
      .help = "the angle of the relief, 0 to 90 degrees; float files hold degrees",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_SHEET, WR_OPTION_MIPS },
      .channels = 1,
      .prepare = wr_export_slope_prepare,
      .rows = wr_export_slope_rows,
      .describe = wr_export_derived_describe },
    { .name = "curvature",
      .label = "curvature",
      .help = "mean curvature, ridges bright, grooves dark, level in the middle; float files "
              "hold it, ridges above 0",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_BEND, WR_OPTION_PART,
                   WR_OPTION_SHEET },
      .channels = 1,
      .make = wr_export_curvature_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "occlusion",
      .label = "ambient occlusion",
      .help =
          "ambient occlusion: visible share of the sky at each texel, 0 to 1, by exact horizons",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_DIRECTIONS, WR_OPTION_REACH,
                   WR_OPTION_SHEET },
      .role = WR_ROLE_OCCLUSION,
      .channels = 1,
      .make = wr_export_occlusion_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "horizon",
      .label = "horizons",
      .help = "slope of the horizon in one direction, or one float channel per direction",
      .options = { DEPTH, CELL, DITHER, OBJECT, WR_OPTION_DIRECTIONS, WR_OPTION_REACH,
                   WR_OPTION_TOWARD, WR_OPTION_STEEPEST, WR_OPTION_SHEET },
      .channels = 1,
      .count_channels = wr_export_horizon_channels,
      .make = wr_export_horizon_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "cavity",
      .label = "cavity",
      .help = "depth below the surroundings, dark in grooves; float files hold the depth, below 0",
      .options = { DEPTH, DITHER, OBJECT, WR_OPTION_RADIUS, WR_OPTION_DEEPEST, WR_OPTION_SHEET },
      .channels = 1,
      .make = wr_export_cavity_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "direction",
      .label = "direction downhill",
      .help = "direction of the slope, 0 to 360 degrees from u towards v; level places are 0",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_SHEET },
      .channels = 1,
      .make = wr_export_direction_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "roughness",
      .label = "roughness",
      .help = "roughness of the relief seen from a distance, from slopes in a box of texels, 0 to "
              "1: the square root of Beckmann's alpha",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_BOX, WR_OPTION_BASE,
                   WR_OPTION_SHEET },
      .role = WR_ROLE_ROUGHNESS,
      .channels = 1,
      .make = wr_export_roughness_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "displacement",
      .label = "displacement",
      .help = "heights above a ground level, in scene units",
      .options = { DEPTH, RANGE, DITHER, OBJECT, WR_OPTION_GROUND, WR_OPTION_SCALE,
                   WR_OPTION_SHEET },
      .role = WR_ROLE_HEIGHT,
      .channels = 1,
      .make = wr_export_displacement_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "mask",
      .label = "mask of heights",
      .help = "white in a range of heights, black elsewhere",
      .options = { DEPTH, DITHER, OBJECT, WR_OPTION_LOW, WR_OPTION_HIGH, WR_OPTION_FEATHER,
                   WR_OPTION_SHEET },
      .channels = 1,
      .make = wr_export_mask_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "wear",
      .label = "edge wear",
      .help = "worn edges: convex places above a threshold, broken up by noise",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_WORN, WR_OPTION_THRESHOLD,
                   WR_OPTION_NOISE, WR_OPTION_GRAIN, WR_OPTION_SHEET },
      .channels = 1,
      .make = wr_export_wear_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_map_describe },
    { .name = "packed",
      .label = "packed maps",
      .help = "several maps as the channels of one picture: occlusion, roughness and metalness, or "
              "those of red=, green=, blue= and alpha=",
      .options = { DEPTH, CELL, SCHEME, DITHER, OBJECT, WR_OPTION_PACK, WR_OPTION_DIRECTIONS,
                   WR_OPTION_REACH, WR_OPTION_BOX, WR_OPTION_BASE, WR_OPTION_SHEET },
      .role = WR_ROLE_CHANNELS,
      .channels = 3,
      .count_channels = wr_export_packed_channels,
      .make = wr_export_packed_make,
      .rows = wr_export_map_rows,
      .describe = wr_export_packed_describe },
    { .name = "contact",
      .label = "contact sheet",
      .help = "overview: small pictures of all maps, each with its name",
      .options = { { "maps", "KIND;KIND...", "maps to show; left out: all maps of the cell",
                     wr_export_parse_contact_maps },
                   { "tile", "PIXELS", "longer side of each picture, 32..1024; left out: 256",
                     wr_export_set_contact_tile },
                   CELL,
                   SCHEME,
                   OBJECT,
                   WR_OPTION_DIRECTIONS,
                   WR_OPTION_REACH,
                   WR_OPTION_BOX,
                   WR_OPTION_BASE,
                   WR_OPTION_SHEET },
      .channels = 3,
      .write = wr_export_contact_write },
    { .name = "lines",
      .label = "line drawing",
      .help = "the cell as a 3D line drawing with hidden lines removed: svg, pdf, or a picture",
      .options = { { "lines", "MxN", "lines along u and along v; left out: 64x64", set_lines },
                   { "view", "TURN,TILT",
                     "degrees about the vertical and above the horizon; left out: 30,35",
                     set_view },
                   { "relief", "HEIGHT or auto",
                     "height of F = 1, in cells; left out: the whole relief is a fifth of a cell "
                     "high",
                     set_relief },
                   { "size", "WIDTHxHEIGHT", "pixels; left out: 1024x768", set_size },
                   { "pen", "WIDTH", "line width in pixels; left out: 1", set_pen },
                   { "hidden", "on or off", "also draw hidden lines; left out: off",
                     wr_export_set_hidden },
                   OBJECT },
      .channels = 1,
      .write = wr_export_line_drawing_write },
    { .name = "profile",
      .label = "profile",
      .help = "heights along a line of the cell as a chart: svg, pdf, or a picture",
      .options = { { "along", "u or v", "the coordinate that the line follows; left out: u",
                     set_along },
                   { "at", "COORDINATE", "the other coordinate, 0..1; left out: 0.5", set_at },
                   { "grid", "N", "divisions of the line; left out: 8", set_grid },
                   SCHEME,
                   { "size", "WIDTHxHEIGHT", "pixels; left out: 1024x768", set_size },
                   { "pen", "WIDTH", "line width in pixels; left out: 1", set_pen },
                   OBJECT },
      .channels = 1,
      .write = wr_export_profile_write },
    { .name = "stl",
      .label = "solid, STL",
      .help = "the relief on its surface as a closed body in millimetres, for printing and milling",
      .solid = true,
      .options = SOLID_OPTIONS,
      .ending = "stl",
      .write = wr_export_solid_write },
    { .name = "ply",
      .label = "solid, PLY",
      .help = "the same body as a binary PLY file",
      .solid = true,
      .options = SOLID_OPTIONS,
      .ending = "ply",
      .write = wr_export_solid_write },
    { .name = "obj",
      .label = "solid, OBJ",
      .help = "the same body as an OBJ file",
      .solid = true,
      .options = SOLID_OPTIONS,
      .ending = "obj",
      .write = wr_export_solid_write },
    { .name = "3mf",
      .label = "solid, 3MF",
      .help = "the same body as a 3MF file, which states its unit",
      .solid = true,
      .options = SOLID_OPTIONS,
      .ending = "3mf",
      .write = wr_export_solid_write },
    { .name = "gltf",
      .label = "solid, glTF",
      .help = "the same body as a glTF file (.glb) in metres, with its material and colours",
      .solid = true,
      .options = SOLID_OPTIONS,
      .ending = "glb",
      .write = wr_export_gltf_write },
    { .name = "glb",
      .label = "glTF model",
      .help = "the object with its normal map, occlusion, roughness, metalness and colours as one "
              "glTF file, in scene units",
      .options = { SCHEME,
                   BODY,
                   { "size", "WIDTHxHEIGHT",
                     "meshes: size of the normal map in texels; left out: the table's",
                     wr_export_set_map_size },
                   WR_OPTION_DIRECTIONS,
                   WR_OPTION_REACH,
                   WR_OPTION_BOX,
                   WR_OPTION_BASE },
      .ending = "glb",
      .write = wr_export_glb_write },
};
_Static_assert(WR_LENGTH(wr_export_kinds) == WR_EXPORT_KIND_COUNT, "export.h counts them");
