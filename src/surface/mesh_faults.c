#include "surface/mesh_faults.h"

#include "base/enum_rows.h"
#include "base/memory.h"
#include "base/text.h"
#include "surface/triangles_internal.h"

#include <string.h>

WR_ROWS(wr_mesh_fault_rows);
const WrMeshFaultRow wr_mesh_fault_rows[WR_MESH_FAULTS] = {
    [WR_ROW(WR_MESH_FAULT_OPEN)] = { "open", "open edges", false },
    [WR_ROW(WR_MESH_FAULT_CROWDED)] = { "crowded", "edges of more than two faces", true },
    [WR_ROW(WR_MESH_FAULT_TURNED)] = { "turned", "edges between faces of opposite orientation",
                                       true },
    [WR_ROW(WR_MESH_FAULT_DOUBLED)] = { "doubled", "doubled faces", true },
    [WR_ROW(WR_MESH_FAULT_NO_AREA)] = { "no_area", "faces without area, left out", false },
};
WR_ROWS_END(wr_mesh_fault_rows, WR_MESH_FAULTS);

static void add(WrMeshFaults *out, WrMeshFault fault, WrVec3 at)
{
    if (out->count[fault]++ > 0) return;
    out->at[fault] = at;
    out->placed[fault] = true;
}

static WrVec3 corner_of(const WrTriangles *mesh, int32_t triangle, int k)
{
    return v3_load(wr_triangle_corner(mesh, triangle, k)->p);
}

/* Returns true if it exchanged them. */
static bool order(int32_t *a, int32_t *b)
{
    const int32_t low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
    const bool exchanged = *a > *b;
    *a = low, *b = high;
    return exchanged;
}

/* Sides of the faces on one set of three positions, kept at the first of them; 0 at the doubled ones. */
enum { SIDE_UP = 1, SIDE_DOWN = 2, SIDE_BOTH = 3 };

/* place: corner -> position; sides [triangles]. */
static bool find_doubled(const WrTriangles *mesh, const int32_t *place, uint8_t *sides,
                         WrMeshFaults *out, WrError *err)
{
    const int32_t count = mesh->triangle_count;
    int32_t kinds, seen = 0;
    int32_t(*key)[3] = wr_try_alloc((size_t)count, sizeof *key, "a mesh's faces", err);
    int32_t *kind =
        key ? wr_try_alloc((size_t)count, 2 * sizeof *kind, "a mesh's faces", err) : NULL;
    int32_t *first = kind ? kind + count : NULL; /* kind -> the first face of it */
    for (int32_t i = 0; i < count && kind; i++) {
        for (int k = 0; k < 3; k++) key[i][k] = place[mesh->triangles[i].corner[k]];
        bool odd = order(&key[i][0], &key[i][1]);
        odd ^= order(&key[i][1], &key[i][2]);
        odd ^= order(&key[i][0], &key[i][1]);
        sides[i] = odd ? SIDE_DOWN : SIDE_UP;
    }
    const bool good = kind && wr_weld(key, sizeof *key, count, kind, &kinds, err);
    for (int32_t i = 0; i < count && good; i++) {
        const WrVec3 sum =
            v3_add(v3_add(corner_of(mesh, i, 0), corner_of(mesh, i, 1)), corner_of(mesh, i, 2));
        if (kind[i] == seen) { /* kinds are numbered by first appearance */
            first[seen++] = i;
            continue;
        }
        add(out, WR_MESH_FAULT_DOUBLED, v3_scale(sum, 1.0 / 3));
        sides[first[kind[i]]] |= sides[i];
        sides[i] = 0;
    }
    wr_free(key);
    wr_free(kind);
    return good;
}

/* Faces that have an edge in its rising direction of positions, in the falling one, and in both: doubled back to back. */
typedef struct Uses {
    int32_t rising, falling, both;
} Uses;

/* Each edge counts at its first half-edge; its uses are cleared then. */
static void count_edges(const WrTriangles *mesh, const int32_t *edge, Uses *uses, WrMeshFaults *out)
{
    for (int32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        const Uses is = uses[edge[h]];
        const int32_t all = is.rising + is.falling + is.both;
        uses[edge[h]] = (Uses){ 0, 0, 0 };
        if (all == 0 || (all == 2 && is.rising < 2 && is.falling < 2)) continue;
        const WrVec3 ends =
            v3_add(corner_of(mesh, h / 3, h % 3), corner_of(mesh, h / 3, (h + 1) % 3));
        add(out,
            all == 1   ? WR_MESH_FAULT_OPEN
            : all == 2 ? WR_MESH_FAULT_TURNED
                       : WR_MESH_FAULT_CROWDED,
            v3_scale(ends, 0.5));
    }
}

static bool find_edges(const WrTriangles *mesh, const WrMeshEdges *edges, const uint8_t *sides,
                       WrMeshFaults *out, WrError *err)
{
    Uses *uses = wr_try_alloc((size_t)edges->count, sizeof *uses, "a mesh's edges", err);
    for (int32_t h = 0; h < 3 * mesh->triangle_count && uses; h++) {
        const int32_t *c = mesh->triangles[h / 3].corner;
        const bool rises = edges->place[c[h % 3]] < edges->place[c[(h + 1) % 3]];
        Uses *use = &uses[edges->edge[h]];
        if (sides[h / 3] == SIDE_BOTH) use->both++;
        else if (sides[h / 3]) *(rises ? &use->rising : &use->falling) += 1;
    }
    if (uses) count_edges(mesh, edges->edge, uses, out);
    wr_free(uses);
    return uses != NULL;
}

static bool find_all(const WrTriangles *mesh, WrMeshFaults *out, WrError *err)
{
    const WrTrianglesReport *report = &mesh->report;
    WrMeshEdges edges;
    *out = (WrMeshFaults){ .count[WR_MESH_FAULT_NO_AREA] = report->no_area,
                           .at[WR_MESH_FAULT_NO_AREA] = v3_load(report->no_area_at),
                           .placed[WR_MESH_FAULT_NO_AREA] = report->no_area_known };
    if (mesh->closed) return true;
    if (!wr_mesh_edges_find(mesh, &edges, err)) return false;
    uint8_t *sides =
        wr_try_alloc((size_t)mesh->triangle_count, sizeof *sides, "a mesh's faces", err);
    const bool good = sides && find_doubled(mesh, edges.place, sides, out, err) &&
                      find_edges(mesh, &edges, sides, out, err);
    wr_free(sides);
    wr_mesh_edges_fini(&edges);
    return good;
}

bool wr_mesh_faults_find(const WrTriangles *mesh, const double origin[3], WrMeshFaults *out,
                         WrError *err)
{
    if (!find_all(mesh, out, err)) return false;
    for (int i = 0; i < WR_MESH_FAULTS; i++)
        out->at[i] = v3_add(out->at[i], (WrVec3){ origin[0], origin[1], origin[2] });
    return true;
}

const char *wr_mesh_faults_body(const WrMeshFaults *faults, const WrTriangles *mesh)
{
    return mesh->closed                             ? "closed"
           : faults->count[WR_MESH_FAULT_OPEN] == 0 ? "no closed body"
                                                    : "open";
}

void wr_mesh_faults_text(const WrMeshFaults *faults, WrText *text)
{
    for (int i = 0; i < WR_MESH_FAULTS; i++) {
        const WrVec3 at = faults->at[i];
        if (faults->count[i] == 0) continue;
        wr_text_addf(text, "; %s: %d", wr_mesh_fault_rows[i].label, (int)faults->count[i]);
        if (faults->placed[i])
            wr_text_addf(text, ", the first at %.7g,%.7g,%.7g", at.x, at.y, at.z);
    }
}
