/* Profiles along the edge of the selection, of a mask, or of the area above a level, by the distance
   from the edge, as for text. */
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/changed_blocks.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select.h"
#include "generate/generator.h"
#include "generate/text_relief.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define KINDS(X)                                                                                   \
    X(RIM_BEVEL, "bevel")                                                                          \
    X(RIM_ROUND, "round") X(RIM_RIDGE, "ridge") X(RIM_OUTLINE, "outline") X(RIM_EMBOSS, "emboss")
enum { KINDS(WR_WORD_ID) };
static const char *const kinds[] = { KINDS(WR_WORD) NULL };

static const char *const sources[] = { WR_RIM_SOURCES(WR_WORD) NULL };

static const WrParam params[] = {
    WR_P_CHOICE("kind", "Kind", RIM_BEVEL, kinds,
                "bevel: a slope, then flat; round: a quarter circle, then flat; ridge: rises up to "
                "the middle; outline: a cord along the edge; emboss: a soft step across the edge"),
    WR_P_CHOICE("of", "Of", WR_RIM_AUTO, sources,
                "shape whose edge is used; auto: the selection, or without one the heights"),
    WR_P_LAYER("a layer below whose outline is used, instead of of="),
    WR_P_ABOVE("width", "Width", 12, 0, 4096, 64, "texels",
               "width of the slope or of the cord; half the width of the step; a ridge rises to "
               "its height over it"),
    WR_P_HEIGHT,
    WR_P_NUMBER("level", "Level", 0.5, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "of=heights: the edge is where heights cross this level"),
    WR_P_END
};

typedef struct Rim {
    const WrField *shape; /* the edge is its contour at 1/2 */
    WrTextShape pieces;
    WrTextInside inside; /* only its rims */
    WrTextNear *near;    /* [threads] */
    int kind;
    double width, height, reach;
} Rim;

/* ---- the edge ---- */

/* Sides along the end of a clamped axis are the table's border, not an edge. */
static bool is_end(const WrTextShape *s, const double a[2], const double b[2])
{
    return (!s->wraps_u && a[0] == b[0] && (a[0] <= 0.0 || a[0] >= s->width)) ||
           (!s->wraps_v && a[1] == b[1] && (a[1] <= 0.0 || a[1] >= s->height));
}

static bool add_loop(WrTextShape *shape, const WrOutline *outline, const WrOutlineLoop *loop,
                     WrError *err)
{
    const double w = shape->width, h = shape->height;
    for (int i = 0; i < loop->count; i++) {
        const bool last = i + 1 == loop->count;
        const WrSelectPoint *p = &outline->points[loop->first + i];
        const WrSelectPoint *q = &outline->points[loop->first + (last ? 0 : i + 1)];
        double a[2] = { p->u * w, (1.0 - p->v) * h };
        double b[2] = { (q->u + (last ? loop->wind_u : 0)) * w,
                        (1.0 - q->v - (last ? loop->wind_v : 0)) * h };
        if (!is_end(shape, a, b) && !wr_text_shape_side(shape, a, b, err)) return false;
    }
    return true;
}

static int compare(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* Orders by row, then column, then content. Outlines come in an arbitrary order; sorting by content makes the sums of
   distances independent of it. */
static int compare_pieces(const void *a, const void *b)
{
    const WrTextPiece *p = a, *q = b;
    int by = compare(p->j, q->j);
    if (!by) by = compare(p->i, q->i);
    if (!by) by = compare(p->y0, q->y0);
    if (!by) by = compare(p->x0, q->x0);
    if (!by) by = compare(p->y1, q->y1);
    return by ? by : compare(p->x1, q->x1);
}

/* Pieces of the edge lie in strips of WR_TILE rows: row j of a strip is pieces[first[j]] to pieces[first[j + 1] - 1]. A tile
   searches only the strips within its reach. */
static bool sort_rims(Rim *rim, WrError *err)
{
    WrTextShape *s = &rim->pieces;
    const int strips = (s->height + WR_TILE - 1) / WR_TILE;
    rim->inside.rims = wr_try_alloc((size_t)strips, sizeof *rim->inside.rims, "an edge", err);
    if (!rim->inside.rims) return false;
    for (int64_t k = 0; k < s->count; k++)
        wr_array_push(&rim->inside.rims[s->pieces[k].j / WR_TILE].pieces, s->pieces[k]);
    for (int strip = 0; strip < strips; strip++) {
        struct WrTextRim *r = &rim->inside.rims[strip];
        if (!wr_progress_report(0.2 * strip / strips)) return wr_fail(err, "cancelled");
        if (r->pieces.count > 1)
            qsort(r->pieces.data, (size_t)r->pieces.count, sizeof *r->pieces.data, compare_pieces);
        int k = 0;
        for (int j = 0; j < WR_TILE; j++) {
            r->first[j] = k;
            while (k < r->pieces.count && r->pieces.data[k].j == strip * WR_TILE + j) k++;
        }
        r->first[WR_TILE] = k;
    }
    return true;
}

static bool find_edge(Rim *rim, const WrField *like, WrError *err)
{
    WrOutline outline = { 0 };
    if (!wr_text_shape_init(&rim->pieces, like, false, err) ||
        !wr_select_outline(rim->shape, &outline, err))
        return false;
    bool good = true;
    for (int i = 0; good && i < outline.loop_count; i++)
        good = add_loop(&rim->pieces, &outline, &outline.loops[i], err);
    wr_outline_fini(&outline);
    return good && sort_rims(rim, err);
}

/* ---- heights ---- */

static double unit(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

/* Height and coverage at d texels inside the edge (below 0: outside). */
static float height_at(const Rim *rim, double d, float *cover)
{
    WR_ROWS(profiles);
    static const WrTextProfile profiles[] = {
        [WR_ROW(RIM_BEVEL)] = WR_TEXT_CHISEL,
        [WR_ROW(RIM_ROUND)] = WR_TEXT_ROUND,
        [WR_ROW(RIM_RIDGE)] = WR_TEXT_RIDGE,
    };
    WR_ROWS_END(profiles, RIM_OUTLINE);
    const double half = 0.5 * rim->width;
    if (rim->kind == RIM_OUTLINE) {
        /* Cord of circular section: h sqrt(1 - (d / half)^2). */
        double across = unit(fabs(d) / half);
        *cover = (float)unit(half - fabs(d) + 0.5);
        return (float)(rim->height * sqrt(1.0 - across * across));
    }
    if (rim->kind == RIM_EMBOSS) {
        double t = unit((d + rim->width) / (2.0 * rim->width));
        *cover = (float)unit(d + rim->width + 0.5);
        return (float)(rim->height * t * t * (3.0 - 2.0 * t));
    }
    const WrTextFinish finish = { profiles[rim->kind], rim->width, rim->height };
    *cover = (float)unit(d + 0.5);
    return *cover > 0.0f ? wr_text_height(&finish, (double)*cover, d >= 0.0, fabs(d)) : 0.0f;
}

static void fill_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                       float *cover)
{
    const Rim *rim = ctx;
    bool want[WR_TILE * WR_TILE];
    float distance[WR_TILE * WR_TILE];
    const float *tile = wr_field_tile(rim->shape, b->i / WR_TILE, b->j / WR_TILE);
    const float level = wr_field_level(rim->shape);
    for (int k = 0; k < WR_TILE * WR_TILE; k++)
        want[k] = k % WR_TILE < b->count_i && k / WR_TILE < b->count_j;
    wr_text_distances(&rim->pieces, &rim->inside, b, rim->reach, want, &rim->near[worker],
                      distance);
    for (int k = 0; k < WR_TILE * WR_TILE; k++) {
        if (!want[k]) continue;
        bool in = (tile ? tile[k] : level) >= 0.5f;
        double d = (double)distance[k];
        heights[k] = height_at(rim, in ? d : -d, &cover[k]);
    }
}

/* ---- the shape ---- */

static WrField *above(const WrField *heights, double level, const WrGenerateJob *job, WrError *err)
{
    const double amount[WR_OP_VALUES] = { 0.5 - level };
    const WrOpOptions options = { .pool = job->pool, .progress = job->progress };
    return wr_op_run(wr_op_find("add"), heights, amount, &options, err);
}

/* The coverage of a layer, or without one the area above the level. */
static WrField *shape_from(const WrParams *p, const WrField *heights, const WrField *cover,
                           const WrGenerateJob *job, WrError *err)
{
    return cover ? wr_field_share(cover) : above(heights, wr_param_number(p, "level"), job, err);
}

static WrField *shape_of_layer(const WrParams *p, const WrGenerateJob *job, WrError *err)
{
    const WrField *heights, *cover;
    if (!wr_generate_layer(job, wr_param_value(p, "layer")->text, &heights, &cover, err))
        return NULL;
    return shape_from(p, heights, cover, job, err);
}

static WrField *shape_of(const WrParams *p, const WrGenerateJob *job, WrError *err)
{
    const char *layer = wr_param_value(p, "layer")->text;
    if (layer && *layer) return shape_of_layer(p, job, err);
    int of = wr_param_whole(p, "of");
    if (of == WR_RIM_AUTO) of = job->selection ? WR_RIM_SELECTION : WR_RIM_HEIGHTS;
    const WrField *field = of == WR_RIM_SELECTION ? job->selection : job->mask;
    if (of == WR_RIM_HEIGHTS) return above(job->like, wr_param_number(p, "level"), job, err);
    if (field) return wr_field_share(field);
    wr_fail(err, of == WR_RIM_MASK ? "of=mask: the layer has no mask"
                                   : "of=selection: nothing is selected");
    return NULL;
}

/* ---- edges made again near changes ---- */

static void mark_piece(const Rim *rim, const WrTextPiece *piece, uint8_t *marked)
{
    const WrFieldRect texel = { piece->i, piece->i + 1, piece->j, piece->j + 1 };
    wr_mark_tiles(rim->shape, &texel, (int)ceil(rim->reach) + 2, marked);
}

/* Marks the surroundings of the pieces that only one of two sorted lists has. */
static void mark_pieces(const Rim *rim, const struct WrTextRim *a, const struct WrTextRim *b,
                        uint8_t *marked)
{
    int k = 0, l = 0;
    while (k < a->pieces.count || l < b->pieces.count) {
        const WrTextPiece *p = k < a->pieces.count ? &a->pieces.data[k] : NULL;
        const WrTextPiece *q = l < b->pieces.count ? &b->pieces.data[l] : NULL;
        const int order = !p ? 1 : !q ? -1 : compare_pieces(p, q);
        if (order < 0) mark_piece(rim, p, marked);
        if (order > 0) mark_piece(rim, q, marked);
        k += order <= 0;
        l += order >= 0;
    }
}

typedef struct Sides {
    const WrField *was, *now;
    uint8_t *marked;
} Sides;

/* Marks a tile with a texel that changes between inside and outside. */
static void mark_sides(int tx, int ty, void *ctx)
{
    const Sides *sides = ctx;
    const float *a = wr_field_tile(sides->was, tx, ty), *b = wr_field_tile(sides->now, tx, ty);
    const float level_a = wr_field_level(sides->was), level_b = wr_field_level(sides->now);
    bool changes = false;
    for (int k = 0; k < WR_TILE * WR_TILE; k++)
        changes |= ((a ? a[k] : level_a) >= 0.5f) != ((b ? b[k] : level_b) >= 0.5f);
    if (changes) sides->marked[ty * wr_field_tiles_u(sides->now) + tx] = 1;
}

static void fini_edge(Rim *rim)
{
    wr_text_inside_fini(&rim->inside, rim->pieces.height);
    wr_text_shape_fini(&rim->pieces);
}

/* Clears the tiles of `wanted` that are the same for another shape of this edge. */
static bool clear_same(const Rim *rim, const WrField *was, const WrGenerateJob *job, WrError *err)
{
    Rim before = { .shape = was };
    uint8_t *marked = job->before->wanted;
    const bool good = find_edge(&before, job->like, err);
    if (good) {
        Sides sides = { was, rim->shape, marked };
        memset(marked, 0, (size_t)wr_field_tiles_u(was) * (size_t)wr_field_tiles_v(was));
        wr_field_changes(was, rim->shape, mark_sides, &sides);
        for (int k = 0; k * WR_TILE < rim->pieces.height; k++)
            mark_pieces(rim, &before.inside.rims[k], &rim->inside.rims[k], marked);
    }
    fini_edge(&before);
    return good;
}

/* The tiles that must be made: *job is that of the generator, whose `wanted` is set. */
static bool find_changes(const Rim *rim, const WrParams *p, WrGenerateJob *job, WrError *err)
{
    const WrMadeBefore *before = job->before;
    const char *layer = wr_param_value(p, "layer")->text;
    const int of = wr_param_whole(p, "of");
    const bool reads =
        (layer && *layer) || of == WR_RIM_HEIGHTS || (of == WR_RIM_AUTO && !job->selection);
    if (!before || !reads || rim->kind == RIM_RIDGE) return true; /* a ridge reaches everywhere */
    WrField *was = shape_from(p, before->heights, before->cover, job, err);
    const bool good = was && clear_same(rim, was, job, err);
    wr_field_free(was);
    job->wanted = before->wanted;
    return good;
}

/* ---- the row ---- */

static bool make_rim(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams p = { params, values };
    WrField *shape = shape_of(&p, job, err);
    if (!shape) return false;
    WrGenerateJob building = *job;
    const int threads = wr_pool_threads(job->pool);
    const double across = (double)wr_field_width(shape) + wr_field_height(shape);
    Rim rim = { .shape = shape,
                .kind = wr_param_whole(&p, "kind"),
                .width = wr_param_number(&p, "width"),
                .height = wr_param_number(&p, "height") };
    rim.reach = rim.kind == RIM_RIDGE || rim.width + 1.0 > across ? across : rim.width + 1.0;
    rim.near = wr_alloc((size_t)threads, sizeof *rim.near);
    bool good = find_edge(&rim, job->like, err) && find_changes(&rim, &p, &building, err) &&
                wr_generate_build(&building, fill_block, &rim, true, 0.2, out, err);
    for (int t = 0; t < threads; t++) wr_text_near_fini(&rim.near[t]);
    wr_free(rim.near);
    fini_edge(&rim);
    wr_field_free(shape);
    return good;
}

const WrGenerator wr_rim_rows[] = {
    { .family = "rim",
      .label = "Edge",
      .help = "bevels, cords and steps along the edge of the selection",
      .blend = "add",
      .params = params,
      .reads = true,
      .make = make_rim },
    { .family = NULL },
};
