/* Vector drawings in relief: the outline of an SVG file's coverage, with the profiles of text. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/picture.h"
#include "generate/text_relief.h"
#include "image/svg.h"

#include <math.h>
#include <string.h>

#define FINE 4.0      /* pixels of the raster per texel: the outline is within 1/25 texel */
#define SIDE_LEAST 64 /* pixels */

#define BOXES(X) X(BOX_DRAWN, "drawn") X(BOX_PAGE, "page")
enum { BOXES(WR_WORD_ID) };
static const char *const boxes[] = { BOXES(WR_WORD) NULL };
#define EDGES(X) X(EDGE_WRAP, "wrap") X(EDGE_CLIP, "clip")
enum { EDGES(WR_WORD_ID) };
static const char *const edges[] = { EDGES(WR_WORD) NULL };
static const char *const takes[] = { WR_SVG_TAKES(WR_WORD) NULL };
static const char *const profiles[] = { WR_TEXT_PROFILES(WR_WORD) NULL };

/* Parameters after those of the drawing. */
#define WR_P_DRAWING                                                                               \
    { .name = "at",                                                                                \
      .label = "At",                                                                               \
      .help = "position of its centre",                                                            \
      .unit = "",                                                                                  \
      .kind = WR_PARAM_TUPLE,                                                                      \
      .fallback = { 0.5, 0.5 },                                                                    \
      .low = -64,                                                                                  \
      .high = 64,                                                                                  \
      .soft_low = 0,                                                                               \
      .soft_high = 1,                                                                              \
      .shape = "u,v",                                                                              \
      .components = 2 },                                                                           \
        WR_P_ABOVE("size", "Size", 256, 0, 65536, 512, "texels", "length of the longest side"),    \
        WR_P_NUMBER("rotate", "Turn", 0, -36000, 36000, 180, "degrees",                            \
                    "anticlockwise, about its middle"),                                            \
        WR_P_CHOICE("edge", "Edges", EDGE_WRAP, edges,                                             \
                    "parts beyond a periodic edge continue on the other side, or are cut off"),    \
        WR_P_CHOICE("profile", "Profile", WR_TEXT_FLAT, profiles,                                  \
                    "profile of the relief's edge; for a ridge, bevel is the run for one height"), \
        WR_P_TEXELS("bevel", "Bevel", 4, 64, "distance from the edge to full height"),             \
        WR_P_HEIGHT, WR_P_END

const WrParam wr_params_svg[] = {
    WR_P_FILE("an SVG file; its text elements are ignored"),
    WR_P_CHOICE("take", "Take", WR_SVG_ALL, takes,
                "parts to use: everything that is drawn, or only the dark or light parts"),
    WR_P_CHOICE("box", "Box", BOX_DRAWN, boxes,
                "size and centre are those of the drawing, or of the page"),
    WR_P_DRAWING
};

const WrParam wr_params_path[] = {
    { .name = "path",
      .label = "Path",
      .help = "path data as in SVG's d: M x,y starts, L x,y is a line, C and Q are curves, A an "
              "arc, Z closes; y points down",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      /* a star of five points */
      .fallback_text = "M0,-50 L12,-15 48,-15 19,6 29,40 0,20 -29,40 -19,6 -48,-15 -12,-15 Z",
      .positional = true,
      .path = true },
    WR_P_DRAWING
};

/* ---- the outline ---- */

static WrField *field_of(const WrSvg *svg, WrError *err)
{
    WrField *field = wr_field_new(svg->width, svg->height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, err);
    float *row = field ? wr_alloc((size_t)svg->width, sizeof *row) : NULL;
    for (int j = 0; field && j < svg->height; j++) {
        const uint8_t *code = svg->cover + (size_t)j * (size_t)svg->width;
        bool empty = true;
        for (int i = 0; i < svg->width; i++) {
            row[i] = (float)code[i] / 255.0f;
            empty = empty && code[i] == 0;
        }
        if (!empty) wr_field_write(field, 0, j, svg->width, 1, row, (size_t)svg->width);
    }
    wr_free(row);
    return field;
}

typedef struct Laying {
    const WrSvg *svg;
    double scale, cosine, sine, at[2];
    WR_ARRAY(double) xy; /* of one loop */
} Laying;

/* A point of the outline in texels from the drawing's middle, y down. */
static void lay_point(Laying *lay, const WrSelectPoint *p)
{
    const double x = lay->scale * (p->u * lay->svg->width - 1.0 - 0.5 * lay->svg->box[0]);
    const double y = lay->scale * ((1.0 - p->v) * lay->svg->height - 1.0 - 0.5 * lay->svg->box[1]);
    wr_array_push(&lay->xy, lay->cosine * x + lay->sine * y);
    wr_array_push(&lay->xy, lay->cosine * y - lay->sine * x);
}

static bool lay_outline(Laying *lay, WrTextShape *shape, WrError *err)
{
    WrOutline outline = { 0 };
    WrField *field = field_of(lay->svg, err);
    bool good = field && wr_select_outline(field, &outline, err);
    wr_field_free(field);
    if (good && outline.loop_count == 0) good = wr_fail(err, "it draws nothing");
    for (int k = 0; good && k < outline.loop_count; k++) {
        const WrOutlineLoop *loop = &outline.loops[k];
        lay->xy.count = 0;
        for (int i = 0; i < loop->count; i++) lay_point(lay, &outline.points[loop->first + i]);
        good = wr_text_shape_add(shape, lay->xy.data, loop->count, lay->at, err) &&
               (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    }
    wr_array_free(&lay->xy);
    wr_outline_fini(&outline);
    return good;
}

/* ---- the rows ---- */

static int32_t side_of(double size, bool coarse)
{
    const double side = ceil(size * (coarse ? 1.0 : FINE));
    return side < SIDE_LEAST        ? SIDE_LEAST
           : side > WR_SVG_SIDE_MAX ? WR_SVG_SIDE_MAX
                                    : (int32_t)side;
}

static bool draw(const WrParams *p, const WrSvg *svg, const WrGenerateJob *job, WrRelief *out,
                 WrError *err)
{
    const double *at = wr_param_value(p, "at")->number;
    const double longest = svg->box[0] > svg->box[1] ? svg->box[0] : svg->box[1];
    const WrTextFinish finish = { (WrTextProfile)wr_param_whole(p, "profile"),
                                  wr_param_number(p, "bevel"), wr_param_number(p, "height") };
    WrTextShape shape = { 0 };
    if (!wr_text_shape_init(&shape, job->like, wr_param_whole(p, "edge") == EDGE_CLIP, err))
        return false;
    Laying lay = { .svg = svg,
                   .scale = wr_param_number(p, "size") / longest,
                   .at = { at[0] * shape.width, (1.0 - at[1]) * shape.height } };
    wr_sincos_turns(wr_param_number(p, "rotate") / 360.0, &lay.sine, &lay.cosine);
    const bool good =
        lay_outline(&lay, &shape, err) && wr_text_relief(&shape, &finish, job, out, err);
    wr_text_shape_fini(&shape);
    return good;
}

bool wr_picture_svg(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                    WrError *err)
{
    const WrParams p = { wr_params_svg, values };
    const char *file = wr_param_value(&p, "file")->text;
    const WrSvgRequest ask = { side_of(wr_param_number(&p, "size"), job->coarse),
                               wr_param_whole(&p, "box") == BOX_PAGE, wr_param_whole(&p, "take") };
    WrSvg svg = { 0 };
    if (!wr_svg_read(file, &ask, &svg, err)) return false;
    if (svg.text)
        wr_generate_note(job,
                         "%s: its text is left out: convert it to paths in the program that drew "
                         "it, or use `text`",
                         file);
    const bool good = draw(&p, &svg, job, out, err);
    if (!good) wr_error_prefix(err, "%s: ", file);
    wr_svg_fini(&svg);
    return good;
}

bool wr_picture_path(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams p = { wr_params_path, values };
    const char *path = wr_param_value(&p, "path")->text;
    const WrSvgRequest ask = { .side = side_of(wr_param_number(&p, "size"), job->coarse) };
    const size_t length = wr_svg_path_span(path);
    if (path[length])
        return wr_fail(err, "path: \"%.20s\": must be commands and numbers of an SVG path",
                       path + length);
    WrText file = { 0 };
    WrSvg svg = { 0 };
    wr_text_addf(&file,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" overflow=\"visible\"><path d=\"%s\"/>"
                 "</svg>",
                 path);
    const bool good = wr_svg_read_bytes("path", file.data, file.length, &ask, &svg, err) &&
                      draw(&p, &svg, job, out, err);
    wr_svg_fini(&svg);
    wr_text_fini(&file);
    return good;
}
