#include "surface/patches.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "surface/surface.h"
#include "surface/triangles_internal.h"

#include <math.h>
#include <string.h>

/* Edges 0..3 of a patch: v = 0, v = 1, u = 0, u = 1; each runs towards larger u or v.
   A set of bicubic patches. points[p][3 * (4 * j + i) + k] is coordinate k of control point (i, j); i runs
   along u and fastest. The patches are turned to face one way, their edges paired, charts into the table laid
   out, and all are cut into triangles whose parts are the patches. */
typedef struct WrPatchEdge {
    int32_t other;  /* 4 * patch + edge of the neighbour; -1: none */
    bool turned;    /* the neighbour's edge has the opposite direction */
    bool collapsed; /* its four points are equal */
    bool backward;  /* points along it are computed from its end, so that both neighbours have the
                     same bits */
} WrPatchEdge;

/* The index of the edge's point i = 0..3 among the patch's sixteen. */
static inline int wr_patch_edge_point(int edge, int i)
{
    return edge < 2 ? 12 * edge + i : 3 * (edge - 2) + 4 * i;
}

/* Union-find: up[i] is the parent of a member, the root's is itself. Shortens the path. */
static inline int32_t wr_root_of(int32_t *up, int32_t i)
{
    while (up[i] != i) {
        up[i] = up[up[i]];
        i = up[i];
    }
    return i;
}

/* ---- Topology of patches: shared edges, loops of open ones, and the charts of the table ---- */

/* ---- edges ---- */

typedef struct EdgeRow {
    float point[4][3];
} EdgeRow;

static bool comes_before(const float a[3], const float b[3])
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k];
    return false;
}

/* Its points in an order independent of the edge's direction.
   An edge and its reverse have the same row of bits, so wr_weld finds shared edges exactly. The direction is
   chosen by the ends; for a closed loop, whose ends are equal, by the inner points. */
static EdgeRow edge_row(const float *points, int edge, WrPatchEdge *out)
{
    float p[4][3];
    for (int i = 0; i < 4; i++)
        memcpy(p[i], points + 3 * wr_patch_edge_point(edge, i), sizeof p[i]);
    out->other = -1;
    out->turned = false;
    out->collapsed = true;
    for (int i = 1; i < 4; i++)
        out->collapsed = out->collapsed && memcmp(p[0], p[i], sizeof p[0]) == 0;
    const bool ends = memcmp(p[0], p[3], sizeof p[0]) != 0;
    out->backward = ends ? comes_before(p[3], p[0]) : comes_before(p[2], p[1]);
    EdgeRow row;
    for (int i = 0; i < 4; i++)
        memcpy(row.point[i], p[out->backward ? 3 - i : i], sizeof row.point[i]);
    return row;
}

/* The first two equal edges become neighbours; further ones are crowded. kind: equal for edges with the
 * same points. */
static void pair_edges(const int32_t *kind, int32_t kinds, int32_t count, WrPatchEdge *edges,
                       WrPatchesReport *report)
{
    int32_t *first = wr_alloc((size_t)kinds, sizeof *first); /* 1 + the edge; -1: already shared */
    for (int32_t i = 0; i < count; i++) {
        int32_t *at = &first[kind[i]];
        if (edges[i].collapsed) {
            report->collapsed++;
        } else if (*at > 0) {
            const int32_t mate = *at - 1;
            const bool turned = edges[i].backward != edges[mate].backward;
            edges[i].other = mate, edges[mate].other = i;
            edges[i].turned = edges[mate].turned = turned;
            report->shared++;
            *at = -1;
        } else if (*at < 0) {
            report->crowded++;
        } else {
            *at = i + 1;
        }
    }
    wr_free(first);
}

/* True if the counter-clockwise boundary, seen from the normal's side, runs in the direction of the
 * edge.
 * In (u, v) the counter-clockwise boundary is v = 0 forwards, u = 1 forwards, v = 1 backwards, u = 0
 * backwards. */
static bool runs_round(int edge)
{
    return edge == 0 || edge == 3;
}

/* Neighbours that face the same side traverse their common edge in opposite directions. */
static bool is_against(const WrPatchEdge *edges, int32_t i)
{
    return (runs_round(i % 4) == runs_round(edges[i].other % 4)) != edges[i].turned;
}

/* Counts connected groups of open edges.
   Union-find over end points: start with one group per point; each edge that connects two groups removes one. */
static bool count_loops(const float (*points)[48], int32_t count, const WrPatchEdge *edges,
                        WrPatchesReport *report, WrError *err)
{
    float(*ends)[3] = wr_try_alloc(2 * (size_t)count, sizeof *ends, "edges of patches", err);
    int32_t *place = wr_alloc(2 * (size_t)count, sizeof *place), places;
    int32_t open = 0;
    for (int32_t i = 0; i < count && ends; i++) {
        if (edges[i].other >= 0 || edges[i].collapsed) continue;
        for (int k = 0; k < 2; k++)
            memcpy(ends[2 * open + k], points[i / 4] + 3 * wr_patch_edge_point(i % 4, 3 * k),
                   sizeof *ends);
        open++;
    }
    bool good = ends && (open == 0 || wr_weld(ends, sizeof *ends, 2 * open, place, &places, err));
    if (good && open > 0) {
        int32_t *up = wr_alloc((size_t)places, sizeof *up);
        for (int32_t i = 0; i < places; i++) up[i] = i;
        report->loops = places;
        for (int32_t i = 0; i < open; i++) {
            const int32_t a = wr_root_of(up, place[2 * i]), b = wr_root_of(up, place[2 * i + 1]);
            report->loops -= a != b;
            up[a] = b;
        }
        wr_free(up);
    }
    report->open = open;
    wr_free(place);
    wr_free(ends);
    return good;
}

/* Finds the shared edges: edges [4 count]. */
static bool patches_find_edges(const float (*points)[48], int32_t count, WrPatchEdge *edges,
                               WrPatchesReport *report, WrError *err)
{
    const int32_t all = 4 * count;
    EdgeRow *rows = wr_try_alloc((size_t)all, sizeof *rows, "edges of patches", err);
    int32_t *kind = wr_alloc((size_t)all, sizeof *kind), kinds;
    for (int32_t i = 0; i < all && rows; i++) rows[i] = edge_row(points[i / 4], i % 4, &edges[i]);
    bool good = rows && wr_weld(rows, sizeof *rows, all, kind, &kinds, err);
    if (good) pair_edges(kind, kinds, all, edges, report);
    for (int32_t i = 0; i < all && good; i++) {
        if (edges[i].other > i) report->against += is_against(edges, i);
    }
    wr_free(kind);
    wr_free(rows);
    return good && count_loops(points, all, edges, report, err);
}

/* ---- orientation ---- */

/* Transposes the 4 x 4 points. That exchanges u and v, and so reverses N = Pu x Pv, without moving the surface
   (HC22). */
static void turn_patch(float points[48])
{
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < j; i++)
            for (int k = 0; k < 3; k++) {
                const int a = 3 * (4 * j + i) + k, b = 3 * (4 * i + j) + k;
                const float kept = points[a];
                points[a] = points[b], points[b] = kept;
            }
}

/* side: 1 like the first of the island, -1 opposite; 0 unknown. Returns the number of patches in the
 * queue.
 * Breadth first. `queue` keeps all patches of the island in order of discovery. */
static int32_t face_island(const WrPatchEdge *edges, int32_t first, signed char *side,
                           int32_t *queue)
{
    int32_t put = 0;
    queue[put++] = first;
    side[first] = 1;
    for (int32_t at = 0; at < put; at++)
        for (int32_t i = 4 * queue[at]; i < 4 * queue[at] + 4; i++) {
            const int32_t other = edges[i].other / 4;
            if (edges[i].other < 0 || side[other]) continue;
            side[other] = (signed char)(is_against(edges, i) ? -side[queue[at]] : side[queue[at]]);
            queue[put++] = other;
        }
    return put;
}

/* Orients connected patches to one side, that of the majority; all: then flips all of them. Flipping
 * exchanges u and v; *turned is their number.
 * The majority decides because there is no outside yet: a set may be open. Whether the whole body is inside
 * out is decided later by the volume of its triangles, and then all = true reverses everything. */
static bool patches_face(float (*points)[48], int32_t count, bool all, int32_t *turned,
                         WrError *err)
{
    WrPatchesReport report = { 0 };
    WrPatchEdge *edges = wr_try_alloc(4 * (size_t)count, sizeof *edges, "patches", err);
    signed char *side = wr_alloc((size_t)count, sizeof *side);
    int32_t *queue = wr_alloc((size_t)count, sizeof *queue);
    const bool good =
        edges && patches_find_edges((const float(*)[48])points, count, edges, &report, err);
    *turned = 0;
    for (int32_t i = 0; i < count && good; i++) {
        if (side[i]) continue;
        const int32_t held = face_island(edges, i, side, queue);
        int32_t others = 0;
        for (int32_t k = 0; k < held; k++) others += side[queue[k]] < 0;
        const int wrong = 2 * others > held ? 1 : -1;
        for (int32_t k = 0; k < held; k++) {
            if ((side[queue[k]] == wrong) == all) continue;
            turn_patch(points[queue[k]]);
            ++*turned;
        }
    }
    wr_free(queue);
    wr_free(side);
    wr_free(edges);
    return good;
}

/* ---- charts ---- */

/* Table's u = of[0] + of[1] u + of[2] v, v = of[3] + of[4] u + of[5] v.
   An affine map with whole coefficients: the linear part is one of the eight symmetries of the square, so
   exactly one of of[1], of[2] and one of of[4], of[5] is not 0. */
typedef struct Chart {
    int32_t of[6];
    bool placed;
} Chart;

typedef struct Spot {
    int32_t u, v;
} Spot;

static Spot chart_at(const Chart *chart, Spot at)
{
    const int32_t *c = chart->of;
    return (Spot){ c[0] + c[1] * at.u + c[2] * at.v, c[3] + c[4] * at.u + c[5] * at.v };
}

/* The edge's start and end, and the outward step from it. */
static void edge_spots(int edge, Spot *from, Spot *to, Spot *out)
{
    static const Spot froms[4] = { { 0, 0 }, { 0, 1 }, { 0, 0 }, { 1, 0 } };
    static const Spot tos[4] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { 1, 1 } };
    static const Spot outs[4] = { { 0, -1 }, { 0, 1 }, { -1, 0 }, { 1, 0 } };
    *from = froms[edge], *to = tos[edge], *out = outs[edge];
}

/* The chart of the patch beyond the edge that continues the table.
   The neighbour's unit square must continue the table: its common edge lies on ours (`along` from its own
   start to its own stop) and its interior lies beyond ours, in direction `on`. These two vectors are the
   images of its u and v axes, in the order given by the edge; the origin follows from the image of its edge's
   start. */
static Chart beyond(const Chart *chart, int edge, const WrPatchEdge *meets)
{
    Spot a, b, out, own_a, own_b, own_out;
    edge_spots(edge, &a, &b, &out);
    edge_spots(meets->other % 4, &own_a, &own_b, &own_out);
    const Spot start = chart_at(chart, meets->turned ? b : a);
    const Spot stop = chart_at(chart, meets->turned ? a : b);
    const int32_t *c = chart->of;
    const Spot on = { c[1] * out.u + c[2] * out.v, c[4] * out.u + c[5] * out.v };
    const Spot along = { stop.u - start.u, stop.v - start.v };
    /* own_out points out of the other patch: the table runs in the opposite direction */
    const int sign = own_out.u + own_out.v;
    const Spot across = { -sign * on.u, -sign * on.v };
    const bool by_u = own_out.v != 0; /* the edge runs along u */
    const Spot du = by_u ? along : across, dv = by_u ? across : along;
    return (Chart){ { start.u - du.u * own_a.u - dv.u * own_a.v, du.u, dv.u,
                      start.v - du.v * own_a.u - dv.v * own_a.v, du.v, dv.v },
                    true };
}

/* The lower left corner of the chart's cell. */
static Spot cell_of(const Chart *chart)
{
    const int32_t *c = chart->of;
    return (Spot){ c[0] + (c[1] + c[2] < 0 ? -1 : 0), c[3] + (c[4] + c[5] < 0 ? -1 : 0) };
}

static void move_cell(Chart *chart, int32_t u, int32_t v)
{
    chart->of[0] += u, chart->of[3] += v;
}

typedef struct Layout {
    const WrPatchEdge *edges;
    Chart *chart;   /* [count] */
    int32_t *queue; /* [count] */
    int32_t *taken; /* occupied cells of the island, a hash table of 1 + patch; [room] */
    size_t room;
    int32_t count;
    bool apart; /* patches of an island have distinct cells */
    int32_t columns, rows;
} Layout;

/* Linear probing; the keys are not stored: a slot holds 1 + patch, and the patch's chart has the cell.
   Multiplication by 2^64 / golden ratio spreads neighbouring cells (Fibonacci hashing). */
static size_t cell_slot(const Layout *l, Spot cell)
{
    const uint64_t key = (uint64_t)(uint32_t)cell.u << 32 | (uint32_t)cell.v;
    size_t at = (size_t)((key * 0x9e3779b97f4a7c15ULL) >> 20) & (l->room - 1);
    for (; l->taken[at]; at = (at + 1) & (l->room - 1)) {
        const Spot own = cell_of(&l->chart[l->taken[at] - 1]);
        if (own.u == cell.u && own.v == cell.v) break;
    }
    return at;
}

/* If patches must not overlap (split), a patch whose cell is occupied is not placed: it starts an island of
   its own later. Otherwise the first patch keeps the slot and others may lie over it. */
static bool place(Layout *l, int32_t patch, const Chart *chart)
{
    const size_t slot = cell_slot(l, cell_of(chart));
    if (l->apart && l->taken[slot]) return false;
    l->chart[patch] = *chart;
    if (!l->taken[slot]) l->taken[slot] = patch + 1;
    return true;
}

/* Lays out all patches reachable from one across edges; the island is then placed beside the previous
 * ones.
 * Breadth first from one patch, so that islands grow round and the table is cut far from the start. Charts are
 * relative to the first patch until the island's extent is known. */
static void lay_island(Layout *l, int32_t first)
{
    const Chart start = { { 0, 1, 0, 0, 0, 1 }, true };
    int32_t put = 0;
    memset(l->taken, 0, l->room * sizeof *l->taken);
    place(l, first, &start);
    l->queue[put++] = first;
    Spot low = { 0, 0 }, high = { 0, 0 };
    for (int32_t at = 0; at < put; at++) {
        const int32_t patch = l->queue[at];
        const Spot cell = cell_of(&l->chart[patch]);
        low.u = cell.u < low.u ? cell.u : low.u, high.u = cell.u > high.u ? cell.u : high.u;
        low.v = cell.v < low.v ? cell.v : low.v, high.v = cell.v > high.v ? cell.v : high.v;
        for (int k = 0; k < 4; k++) {
            const WrPatchEdge *edge = &l->edges[4 * patch + k];
            if (edge->other < 0 || l->chart[edge->other / 4].placed) continue;
            const Chart chart = beyond(&l->chart[patch], k, edge);
            if (place(l, edge->other / 4, &chart)) l->queue[put++] = edge->other / 4;
        }
    }
    for (int32_t i = 0; i < put; i++) move_cell(&l->chart[l->queue[i]], l->columns - low.u, -low.v);
    l->columns += high.u - low.u + 1;
    l->rows = high.v - low.v + 1 > l->rows ? high.v - low.v + 1 : l->rows;
}

/* For whole tables: cells are irrelevant.
   Each chart moves to cell (0, 0): only its turn and mirroring matter, as every patch has the whole table. */
static void gather_cells(Layout *l)
{
    for (int32_t i = 0; i < l->count; i++) {
        const Spot cell = cell_of(&l->chart[i]);
        move_cell(&l->chart[i], -cell.u, -cell.v);
    }
    l->columns = l->rows = 1;
}

/* True if the table continues across the edge. For whole tables, edges may also meet at the table's
 * border. */
static bool runs_on(const Layout *l, int32_t i)
{
    const Chart want = beyond(&l->chart[i / 4], i % 4, &l->edges[i]);
    const Chart *own = &l->chart[l->edges[i].other / 4];
    for (int k = 0; k < 6; k++)
        if (want.of[k] != own->of[k] && (l->apart || k % 3 != 0)) return false;
    return true;
}

/* One cell for each patch, row by row from the lower left, with a margin. Nothing is joined.
   Two neighbours then never share a texel, and interpolation reads only margin texels of its own cell. */
static void take_cells(WrPatches *set, WrPatch *patch)
{
    const float margin = (float)WR_PATCH_MARGIN, side = 1 - 2 * margin;
    const int32_t columns = (int32_t)ceil(sqrt((double)set->count));
    set->columns = columns, set->rows = (set->count + columns - 1) / columns;
    set->scale_u = 1.0 / set->columns, set->scale_v = 1.0 / set->rows;
    for (int32_t i = 0; i < set->count; i++) {
        const float chart[6] = { (float)(i % columns) + margin, side, 0,
                                 (float)(i / columns) + margin, 0,    side };
        memcpy(patch[i].chart, chart, sizeof chart);
    }
}

static void take_charts(const Layout *l, WrPatches *set, WrPatch *patch)
{
    for (int32_t i = 0; i < l->count; i++)
        for (int k = 0; k < 6; k++) patch[i].chart[k] = (float)l->chart[i].of[k];
    for (int32_t i = 0; i < 4 * l->count; i++)
        if (l->edges[i].other > i) set->report.joined += runs_on(l, i);
    set->columns = l->columns, set->rows = l->rows;
    set->scale_u = 1.0 / l->columns, set->scale_v = 1.0 / l->rows;
}

/* Computes the charts for set->table; counts the joined edges. */
static bool patches_lay_out(WrPatches *set, WrPatch *patch, const WrPatchEdge *edges, WrError *err)
{
    const size_t count = (size_t)set->count;
    if (set->table == WR_PATCH_OWN) {
        take_cells(set, patch);
        return true;
    }
    Layout l = { .edges = edges, .count = set->count, .apart = set->table == WR_PATCH_SPLIT };
    l.room = 16;
    while (l.room < 2 * count) l.room *= 2;
    l.chart = wr_try_alloc(count, sizeof *l.chart, "charts of patches", err);
    if (!l.chart) return false;
    l.queue = wr_alloc(count, sizeof *l.queue);
    l.taken = wr_alloc(l.room, sizeof *l.taken);
    for (int32_t i = 0; i < set->count; i++) {
        const Chart own = { { 0, 1, 0, 0, 0, 1 }, true };
        if (set->table == WR_PATCH_EACH) l.chart[i] = own;
        else if (!l.chart[i].placed) lay_island(&l, i);
    }
    if (set->table != WR_PATCH_SPLIT) gather_cells(&l);
    take_charts(&l, set, patch);
    wr_free(l.taken);
    wr_free(l.queue);
    wr_free(l.chart);
    return true;
}

/* ---- Parser of patch sets ---- */

#define POINTS_MAX (16 * WR_PATCHES_MAX)
#define SHOWN 24 /* maximum letters of a quoted word */

typedef struct Reader {
    const char *at, *end;
    int line;
} Reader;

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
}

static void skip_space(Reader *r)
{
    bool remark = false;
    for (; r->at < r->end; r->at++) {
        if (*r->at == '\n') r->line++, remark = false;
        else if (*r->at == '#') remark = true;
        else if (!remark && !is_space(*r->at)) return;
    }
}

/* The next word; length 0 at the end. */
static const char *next_word(Reader *r, size_t *length)
{
    skip_space(r);
    const char *from = r->at;
    while (r->at < r->end && !is_space(*r->at) && *r->at != '#') r->at++;
    *length = (size_t)(r->at - from);
    return from;
}

static bool bad_word(const Reader *r, const char *word, size_t length, const char *what,
                     WrError *err)
{
    const int shown = length < SHOWN ? (int)length : SHOWN;
    if (length == 0) return wr_fail(err, "line %d: the file ends before %s", r->line, what);
    return wr_fail(err, "line %d: \"%.*s\" is not %s", r->line, shown, word, what);
}

static bool read_number(Reader *r, float *out, WrError *err)
{
    size_t length;
    double number;
    const char *word = next_word(r, &length);
    if (!wr_number_parse(word, length, &number) || !(fabs(number) <= 1e30))
        return bad_word(r, word, length, "a coordinate, a number within 1e30 of 0", err);
    *out = (float)number + 0.0f; /* -0 is 0 */
    return true;
}

static bool read_whole(Reader *r, int32_t low, int32_t high, const char *what, int32_t *out,
                       WrError *err)
{
    size_t length;
    double number;
    const char *word = next_word(r, &length);
    char report[120];
    snprintf(report, sizeof report, "%s, %d..%d", what, (int)low, (int)high);
    if (!wr_number_parse(word, length, &number) || !(number >= low && number <= high) ||
        number != floor(number))
        return bad_word(r, word, length, report, err);
    *out = (int32_t)number;
    return true;
}

static bool read_point(Reader *r, float *out, WrError *err)
{
    return read_number(r, out, err) && read_number(r, out + 1, err) && read_number(r, out + 2, err);
}

/* "3 3" and sixteen points each. */
static bool read_blocks(Reader *r, float (*points)[48], int32_t count, WrError *err)
{
    for (int32_t i = 0; i < count; i++) {
        char what[60];
        int32_t degree;
        snprintf(what, sizeof what, "a degree of patch %d", (int)i + 1);
        for (int k = 0; k < 2; k++) /* along u, along v */
            if (!read_whole(r, 3, 3, what, &degree, err)) return false;
        for (int k = 0; k < 16; k++)
            if (!read_point(r, points[i] + 3 * k, err)) return false;
    }
    return true;
}

/* Rows of sixteen indices, stored as floats in the points' memory until the points are known. */
static bool read_list(Reader *r, float (*points)[48], int32_t count, WrError *err)
{
    int32_t known, most = 0, number;
    for (int32_t i = 0; i < 16 * count; i++) {
        if (!read_whole(r, 1, POINTS_MAX, "the number of a point", &number, err)) return false;
        most = number > most ? number : most;
        points[i / 16][3 * (i % 16)] = (float)number;
    }
    if (!read_whole(r, 1, POINTS_MAX, "the count of points", &known, err)) return false;
    if (most > known)
        return wr_fail(err, "line %d: %d points, but a patch refers to point %d", r->line,
                       (int)known, (int)most);
    float *point = wr_try_alloc((size_t)known, 3 * sizeof *point, "points of patches", err);
    bool good = point != NULL;
    for (int32_t i = 0; i < known && good; i++) good = read_point(r, point + 3 * (size_t)i, err);
    for (int32_t i = 0; i < 16 * count && good; i++) {
        float *to = points[i / 16] + 3 * (i % 16);
        memcpy(to, point + 3 * ((size_t)*to - 1), 3 * sizeof *to);
    }
    wr_free(point);
    return good;
}

/* True if the next line has two numbers: then blocks follow, else a list with sixteen. */
static bool blocks_follow(Reader r)
{
    size_t length;
    (void)next_word(&r, &length);
    const int line = r.line;
    (void)next_word(&r, &length);
    skip_space(&r);
    return r.line > line;
}

bool wr_patches_parse(const char *text, size_t length, float (**points)[48], int32_t *count,
                      WrError *err)
{
    Reader r = { text, text + length, 1 };
    size_t left;
    if (!read_whole(&r, 1, WR_PATCHES_MAX, "the count of patches", count, err)) return false;
    *points = wr_try_alloc((size_t)*count, sizeof **points, "patches", err);
    if (!*points) return false;
    bool good = blocks_follow(r) ? read_blocks(&r, *points, *count, err)
                                 : read_list(&r, *points, *count, err);
    const char *rest = good ? next_word(&r, &left) : NULL;
    if (good && left > 0)
        good = bad_word(&r, rest, left, "expected: all patches have been read, the end", err);
    if (good) return true;
    wr_free(*points);
    *points = NULL;
    return false;
}

const char *const wr_patch_tables[WR_PATCH_TABLES] = { "each", "joined", "split", "own" };

void wr_patches_free(WrPatches *patches)
{
    if (!patches) return;
    wr_free((void *)patches->patch);
    wr_free((void *)patches->of);
    wr_free(patches);
}

/* ---- one patch ---- */

/* Second derivatives of a Bezier patch are convex combinations of 6 (P0 - 2 P1 + P2) along u or v, and mixed
   ones of 9 (P00 - P10 - P01 + P11); the largest of these vectors bounds the derivative over the whole patch
   (convex hull). */

static void shape_of(const float *points, WrShape *shape)
{
    wr_shape_default(WR_SURFACE_bezier, shape);
    for (int i = 0; i < 48; i++) shape->value[i] = (double)points[i];
}

static double size_of(const float *points, const int at[4], const double by[4])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double x = 0;
        for (int i = 0; i < 4; i++)
            if (by[i] != 0) x += by[i] * (double)points[3 * at[i] + k];
        sum += x * x;
    }
    return sqrt(sum);
}

/* Bounds of |Puu|, |Puv|, |Pvv|, from differences of points. */
typedef struct Bend {
    double uu, uv, vv;
} Bend;

static Bend bend_of(const float *points)
{
    static const double second[4] = { 6, -12, 6, 0 }, mixed[4] = { 9, -9, -9, 9 };
    Bend bend = { 0, 0, 0 };
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 2; i++) {
            const int along[4] = { 4 * j + i, 4 * j + i + 1, 4 * j + i + 2, 0 };
            const int across[4] = { 4 * i + j, 4 * i + j + 4, 4 * i + j + 8, 0 };
            bend.uu = fmax(bend.uu, size_of(points, along, second));
            bend.vv = fmax(bend.vv, size_of(points, across, second));
        }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            const int at = 4 * j + i, corner[4] = { at, at + 1, at + 4, at + 5 };
            bend.uv = fmax(bend.uv, size_of(points, corner, mixed));
        }
    return bend;
}

/* ---- subdivision counts ---- */

typedef struct Build {
    const float (*points)[48];
    WrPatchEdge *edges; /* [4 count] */
    int32_t *up;        /* [2 count] u and v of each patch: union-find of those with equal counts */
    int *cuts;          /* [2 count], for the root */
    float (*place)[3];
    float (*normal)[3];
    float (*uv)[2];
    int32_t (*corner)[3];
    WrTrianglePart *parts;
    int32_t count, place_count, triangle_count;
    WrPatches *set;
    WrPatch *patch;
} Build;

static int cuts_of(const Build *b, int32_t patch, int axis)
{
    return b->cuts[wr_root_of(b->up, 2 * patch + axis)];
}

static double extent(const Build *b)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 48; k++) {
            low[k % 3] = fmin(low[k % 3], (double)b->points[i][k]);
            high[k % 3] = fmax(high[k % 3], (double)b->points[i][k]);
        }
    return 0.5 * wr_hypot(wr_hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

/* Chooses counts by |P - its triangle| <= (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8, half of the
 * error for each direction.
 * With 2 du dv <= du^2 + dv^2 each axis may have half the error: (|Puu| + |Puv|) / (8 n^2) <= off / 2. */
static void ask_cuts(Build *b, double off)
{
    for (int32_t i = 0; i < 2 * b->count; i++) b->cuts[i] = 1;
    for (int32_t i = 0; i < b->count; i++) {
        const Bend bend = bend_of(b->points[i]);
        for (int axis = 0; axis < 2; axis++) {
            const double own = (axis ? bend.vv : bend.uu) + bend.uv;
            const double cuts = off > 0 ? ceil(sqrt(own / (4 * off))) : 1;
            int *at = &b->cuts[wr_root_of(b->up, 2 * i + axis)];
            const int wanted = cuts < WR_PATCH_CUTS_MAX ? (int)cuts : WR_PATCH_CUTS_MAX;
            if (wanted > *at) *at = wanted;
        }
    }
}

static void count_triangles(Build *b)
{
    b->place_count = b->triangle_count = 0;
    for (int32_t i = 0; i < b->count; i++) {
        const int32_t nu = cuts_of(b, i, 0), nv = cuts_of(b, i, 1);
        b->place_count += (nu + 1) * (nv + 1);
        b->triangle_count += 2 * nu * nv;
    }
}

/* The two opposite edges of a patch have the same count, and both patches at a shared edge too, else there
   would be cracks; so whole strips of patches form one class of the union-find, and its largest wish counts.
   If the total is too large, the tolerance doubles: counts fall by sqrt(2) per step. */
static void choose_cuts(Build *b)
{
    for (int32_t i = 0; i < 2 * b->count; i++) b->up[i] = i;
    for (int32_t i = 0; i < 4 * b->count; i++) {
        const int32_t other = b->edges[i].other;
        if (other < i) continue;
        b->up[wr_root_of(b->up, 2 * (i / 4) + i % 4 / 2)] =
            wr_root_of(b->up, 2 * (other / 4) + other % 4 / 2);
    }
    double off = WR_PATCH_OFF * extent(b);
    do {
        ask_cuts(b, off);
        count_triangles(b);
        off *= 2;
    } while (b->triangle_count > WR_PATCH_TRIANGLES && off > 0 && isfinite(off));
}

/* ---- triangles ---- */

/* Bernstein form; the same expression for every edge, so equal control points in equal order yield equal bits. */
static double mix4(const double p[4], double t)
{
    const double w = 1 - t;
    return w * w * w * p[0] + 3 * w * w * t * p[1] + 3 * w * t * t * p[2] + t * t * t * p[3];
}

/* The point of step i of n on an edge, computed from the same end for both neighbours. */
static void edge_place(const Build *b, int32_t patch, int edge, int i, int n, float out[3])
{
    const WrPatchEdge *own = &b->edges[4 * patch + edge];
    const double t = own->backward ? (double)(n - i) / n : (double)i / n;
    for (int k = 0; k < 3; k++) {
        double p[4];
        for (int j = 0; j < 4; j++)
            p[j] =
                (double)
                    b->points[patch][3 * wr_patch_edge_point(edge, own->backward ? 3 - j : j) + k];
        out[k] = (float)(own->collapsed ? p[0] : mix4(p, t)) + 0.0f;
    }
}

/* Normals come from each patch itself: creases stay where patches meet at an angle. Positions on edges are
   replaced by edge_place's, because wr_surface_at sums sixteen terms in another order and would differ in the
   last bit. */
static void put_place(Build *b, int32_t patch, const WrShape *shape, int i, int j)
{
    const int nu = cuts_of(b, patch, 0), nv = cuts_of(b, patch, 1);
    const int32_t at = b->place_count++;
    WrSurfacePoint point;
    wr_surface_at(shape, 0, (double)i / nu, (double)j / nv, &point);
    const WrVec3 p = point.p, n = point.n_unit;
    b->place[at][0] = (float)p.x + 0.0f, b->place[at][1] = (float)p.y + 0.0f;
    b->place[at][2] = (float)p.z + 0.0f;
    b->normal[at][0] = (float)n.x, b->normal[at][1] = (float)n.y, b->normal[at][2] = (float)n.z;
    b->uv[at][0] = (float)i / (float)nu, b->uv[at][1] = (float)j / (float)nv;
    /* ends of edges are the patch's corners, bit for bit, for both edges */
    if (j == 0 || j == nv) edge_place(b, patch, j == 0 ? 0 : 1, i, nu, b->place[at]);
    if (i == 0 || i == nu) edge_place(b, patch, i == 0 ? 2 : 3, j, nv, b->place[at]);
}

/* Vertices row by row, i fastest; each patch has its own, wr_weld merges those of shared edges later.
   Triangles without area (collapsed edges) are dropped by wr_triangles_new. */
static void cut_patch(Build *b, int32_t patch)
{
    const int nu = cuts_of(b, patch, 0), nv = cuts_of(b, patch, 1);
    const int32_t first = b->place_count, from = b->triangle_count;
    WrShape shape;
    shape_of(b->points[patch], &shape);
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++) put_place(b, patch, &shape, i, j);
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            const int32_t a = first + j * (nu + 1) + i, c = a + nu + 2;
            const int32_t two[2][3] = { { a, a + 1, c }, { a, c, c - 1 } };
            memcpy(b->corner[b->triangle_count], two, sizeof two);
            b->triangle_count += 2;
        }
    b->parts[patch] =
        (WrTrianglePart){ .first = from, .count = b->triangle_count - from, .patch = patch };
    b->patch[patch].reach_u = 1.0f / (float)nu;
    b->patch[patch].reach_v = 1.0f / (float)nv;
}

static WrTriangles *cut_all(Build *b, WrError *err)
{
    const size_t places = (size_t)b->place_count, triangles = (size_t)b->triangle_count;
    const char *what = "triangles of patches";
    b->place = wr_try_alloc(places, sizeof *b->place, what, err);
    b->normal = b->place ? wr_try_alloc(places, sizeof *b->normal, what, err) : NULL;
    b->uv = b->normal ? wr_try_alloc(places, sizeof *b->uv, what, err) : NULL;
    b->corner = b->uv ? wr_try_alloc(triangles, sizeof *b->corner, what, err) : NULL;
    b->parts = b->corner ? wr_try_alloc((size_t)b->count, sizeof *b->parts, what, err) : NULL;
    if (!b->parts) return NULL;
    b->place_count = b->triangle_count = 0;
    for (int32_t i = 0; i < b->count; i++) cut_patch(b, i);
    const WrTrianglesSource source = { .points = (const float(*)[3])b->place,
                                       .normals = (const float(*)[3])b->normal,
                                       .uv = (const float(*)[2])b->uv,
                                       .corners = (const int32_t(*)[3])b->corner,
                                       .point_count = b->place_count,
                                       .triangle_count = b->triangle_count,
                                       .parts = b->parts,
                                       .part_count = b->count };
    return wr_triangles_new(&source, err);
}

/* ---- creases ---- */

/* Edges 0 and 1 run along u at v = 0 and 1; edges 2 and 3 along v at u = 0 and 1. */
static WrVec3 normal_on_edge(const float *points, int edge, double t)
{
    WrShape shape;
    WrSurfacePoint at;
    shape_of(points, &shape);
    wr_surface_at(&shape, 0, edge < 2 ? t : edge - 2, edge < 2 ? edge : t, &at);
    return at.n_unit;
}

#define CREASE 0.1      /* smallest angle of a crease, in degrees */
#define CREASE_MEANT 45 /* larger angles are always intended */

/* Five points, none at the ends, where several patches meet. An angle above 90 degrees compares normals of
   opposite sides. The reported patch pair is the worst crease that may be a slip in the data, such as patch 11
   of the teapot's list (HC152). */
static void find_creases(Build *b, WrPatchesReport *report)
{
    for (int32_t i = 0; i < 4 * b->count; i++) {
        const WrPatchEdge *edge = &b->edges[i];
        if (edge->other < i) continue;
        double worst = 0;
        for (int k = 0; k < 5; k++) {
            const double t = 0.1 + 0.2 * k;
            const WrVec3 own = normal_on_edge(b->points[i / 4], i % 4, t);
            const WrVec3 other = normal_on_edge(b->points[edge->other / 4], edge->other % 4,
                                                edge->turned ? 1 - t : t);
            const double angle = wr_angle(own, other) * (180 / WR_PI);
            worst = fmax(worst, angle > 90 ? 180 - angle : angle);
        }
        report->creased += worst >= CREASE;
        if (worst < CREASE || worst > CREASE_MEANT || worst <= report->crease_deg) continue;
        report->crease_deg = worst;
        report->crease_of[0] = i / 4, report->crease_of[1] = edge->other / 4;
    }
}

/* ---- construction ---- */

static bool number_triangles(WrTriangles *made, WrPatches *set, WrError *err)
{
    int32_t *of = wr_try_alloc((size_t)made->triangle_count, sizeof *of, "patches", err);
    set->of = of;
    for (int32_t part = 0; part < made->part_count && of; part++) {
        const WrTrianglePart *from = &made->parts[part];
        for (int32_t i = 0; i < from->count; i++) of[from->first + i] = from->patch;
    }
    return of != NULL;
}

/* The key distinguishes shapes.
   The triangles' hash does not contain the charts, so the same body with another table layout must have
   another key. */
static uint64_t key_of(const WrTriangles *made, const WrPatches *set)
{
    const WrHash start = { made->key, 1 + (uint64_t)set->table };
    return wr_hash_bytes(set->patch, (size_t)set->count * sizeof *set->patch, start).low;
}

static WrTriangles *finish(Build *b, WrError *err)
{
    WrPatches *set = b->set;
    WrTriangles *made = NULL;
    if (patches_find_edges(b->points, b->count, b->edges, &set->report, err) &&
        patches_lay_out(set, b->patch, b->edges, err)) {
        choose_cuts(b);
        made = cut_all(b, err);
    }
    if (!made) return NULL;
    find_creases(b, &set->report);
    made->patches = set;
    if (!number_triangles(made, set, err)) {
        b->set = NULL; /* freed with the triangles */
        wr_triangles_free(made);
        return NULL;
    }
    made->key = key_of(made, set);
    return made;
}

static WrTriangles *build(const float (*points)[48], int32_t count, WrPatchTable table,
                          WrError *err)
{
    Build b = { .points = points, .count = count };
    const size_t patches = (size_t)count;
    b.patch = wr_try_alloc(patches, sizeof *b.patch, "patches", err);
    if (!b.patch) return NULL;
    for (size_t i = 0; i < patches; i++)
        memcpy(b.patch[i].point, points[i], sizeof b.patch[i].point);
    b.set = wr_alloc(1, sizeof *b.set);
    *b.set = (WrPatches){ .patch = b.patch, .count = count, .table = table };
    b.edges = wr_alloc(4 * patches, sizeof *b.edges);
    b.up = wr_alloc(2 * patches, sizeof *b.up);
    b.cuts = wr_alloc(2 * patches, sizeof *b.cuts);
    WrTriangles *made = finish(&b, err);
    if (!made) wr_patches_free(b.set);
    wr_free(b.edges);
    wr_free(b.up);
    wr_free(b.cuts);
    wr_free(b.place);
    wr_free(b.normal);
    wr_free(b.uv);
    wr_free(b.corner);
    wr_free(b.parts);
    return made;
}

/* Orients a closed body outwards. */
static WrTriangles *face_and_build(float (*points)[48], int32_t count, WrPatchTable table,
                                   WrError *err)
{
    int32_t turned, inside;
    if (!patches_face(points, count, false, &turned, err)) return NULL;
    WrTriangles *made = build((const float(*)[48])points, count, table, err);
    if (made && made->report.inside_out) {
        wr_triangles_free(made);
        if (!patches_face(points, count, true, &inside, err)) return NULL;
        made = build((const float(*)[48])points, count, table, err);
        turned = count - turned;
    }
    if (made) made->patches->report.turned = turned;
    return made;
}

WrTriangles *wr_patches_new(const float (*points)[48], int32_t count, WrPatchTable table,
                            WrError *err)
{
    if (count < 1 || count > WR_PATCHES_MAX) {
        wr_fail(err, "%d patches: must be 1..%d", (int)count, WR_PATCHES_MAX);
        return NULL;
    }
    float(*own)[48] = wr_try_alloc((size_t)count, sizeof *own, "patches", err);
    if (!own) return NULL;
    memcpy(own, points, (size_t)count * sizeof *own);
    WrTriangles *made = face_and_build(own, count, table, err);
    wr_free(own);
    return made;
}

/* ---- documents ---- */

enum { HEAD = 3 }; /* WR_PATCHES_PACKED, count, table */

float *wr_patches_serialize(const WrPatches *patches, size_t *count)
{
    *count = HEAD + 48 * (size_t)patches->count;
    float *block = wr_alloc(*count, sizeof *block);
    block[0] = WR_PATCHES_PACKED;
    block[1] = (float)patches->count;
    block[2] = (float)patches->table;
    for (int32_t i = 0; i < patches->count; i++)
        memcpy(block + HEAD + 48 * (size_t)i, patches->patch[i].point, 48 * sizeof *block);
    return block;
}

WrTriangles *wr_patches_deserialize(const float *block, size_t count, WrError *err)
{
    const bool head = count >= HEAD && block[0] == (float)WR_PATCHES_PACKED && block[1] >= 1 &&
                      block[1] <= WR_PATCHES_MAX && block[2] >= 0 && block[2] < WR_PATCH_TABLES;
    if (!head || count < HEAD + 48 * (size_t)block[1]) {
        wr_fail(err, "the stored patches are inconsistent");
        return NULL;
    }
    for (size_t i = 0; i < 48 * (size_t)block[1]; i++)
        if (!(fabsf(block[HEAD + i]) <= 1e30f)) {
            wr_fail(err, "the stored patches are damaged");
            return NULL;
        }
    return wr_patches_new((const float(*)[48])(const void *)(block + HEAD), (int32_t)block[1],
                          (WrPatchTable)(int)block[2], err);
}
