/* Topology of patches: shared edges, loops of open ones, and the charts of the table. */
#include "surface/patches_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/triangles_internal.h"

#include <math.h>
#include <string.h>

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

/* Its points in an order independent of the edge's direction. */
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
                       WrPatchesTold *told)
{
    int32_t *first = wr_alloc((size_t)kinds, sizeof *first); /* 1 + the edge; -1: already shared */
    for (int32_t i = 0; i < count; i++) {
        int32_t *at = &first[kind[i]];
        if (edges[i].collapsed) {
            told->collapsed++;
        } else if (*at > 0) {
            const int32_t mate = *at - 1;
            const bool turned = edges[i].backward != edges[mate].backward;
            edges[i].other = mate, edges[mate].other = i;
            edges[i].turned = edges[mate].turned = turned;
            told->shared++;
            *at = -1;
        } else if (*at < 0) {
            told->crowded++;
        } else {
            *at = i + 1;
        }
    }
    wr_free(first);
}

/* True if the counter-clockwise boundary, seen from the normal's side, runs in the direction of the
 * edge. */
static bool runs_round(int edge)
{
    return edge == 0 || edge == 3;
}

/* Neighbours that face the same side traverse their common edge in opposite directions. */
static bool is_against(const WrPatchEdge *edges, int32_t i)
{
    return (runs_round(i % 4) == runs_round(edges[i].other % 4)) != edges[i].turned;
}

/* Counts connected groups of open edges. */
static bool count_loops(const float (*points)[48], int32_t count, const WrPatchEdge *edges,
                        WrPatchesTold *told, WrError *err)
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
        told->loops = places;
        for (int32_t i = 0; i < open; i++) {
            const int32_t a = wr_root_of(up, place[2 * i]), b = wr_root_of(up, place[2 * i + 1]);
            told->loops -= a != b;
            up[a] = b;
        }
        wr_free(up);
    }
    told->open = open;
    wr_free(place);
    wr_free(ends);
    return good;
}

bool wr_patches_find_edges(const float (*points)[48], int32_t count, WrPatchEdge *edges,
                           WrPatchesTold *told, WrError *err)
{
    const int32_t all = 4 * count;
    EdgeRow *rows = wr_try_alloc((size_t)all, sizeof *rows, "edges of patches", err);
    int32_t *kind = wr_alloc((size_t)all, sizeof *kind), kinds;
    for (int32_t i = 0; i < all && rows; i++) rows[i] = edge_row(points[i / 4], i % 4, &edges[i]);
    bool good = rows && wr_weld(rows, sizeof *rows, all, kind, &kinds, err);
    if (good) pair_edges(kind, kinds, all, edges, told);
    for (int32_t i = 0; i < all && good; i++) {
        if (edges[i].other > i) told->against += is_against(edges, i);
    }
    wr_free(kind);
    wr_free(rows);
    return good && count_loops(points, all, edges, told, err);
}

/* ---- orientation ---- */

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
 * queue. */
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

bool wr_patches_face(float (*points)[48], int32_t count, bool all, int32_t *turned, WrError *err)
{
    WrPatchesTold told = { 0 };
    WrPatchEdge *edges = wr_try_alloc(4 * (size_t)count, sizeof *edges, "patches", err);
    signed char *side = wr_alloc((size_t)count, sizeof *side);
    int32_t *queue = wr_alloc((size_t)count, sizeof *queue);
    const bool good =
        edges && wr_patches_find_edges((const float(*)[48])points, count, edges, &told, err);
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

/* Table's u = of[0] + of[1] u + of[2] v, v = of[3] + of[4] u + of[5] v. */
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

/* The chart of the patch beyond the edge that continues the table. */
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

static bool place(Layout *l, int32_t patch, const Chart *chart)
{
    const size_t slot = cell_slot(l, cell_of(chart));
    if (l->apart && l->taken[slot]) return false;
    l->chart[patch] = *chart;
    if (!l->taken[slot]) l->taken[slot] = patch + 1;
    return true;
}

/* Lays out all patches reachable from one across edges; the island is then placed beside the previous
 * ones. */
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

/* For whole tables: cells are irrelevant. */
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

/* One cell for each patch, row by row from the lower left, with a margin. Nothing is joined. */
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
        if (l->edges[i].other > i) set->told.joined += runs_on(l, i);
    set->columns = l->columns, set->rows = l->rows;
    set->scale_u = 1.0 / l->columns, set->scale_v = 1.0 / l->rows;
}

bool wr_patches_lay_out(WrPatches *set, WrPatch *patch, const WrPatchEdge *edges, WrError *err)
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
