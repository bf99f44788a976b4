#include "surface/relief_weights.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"
#include "field/scheme.h"
#include "field/scheme_list.h"
#include "surface/projection.h"
#include "surface/triangles_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROUNDING 1e-6 /* cosine by which a face at exactly the angle is inside */
#define LISTED 8      /* names of materials in a message */

struct WrReliefWeights {
    WrProjectionFrame frame;
    WrFacing facing; /* of the soft mask; ANY: none */
    bool from_centre;
    double whole, none; /* cosines at which m is 1 and 0 */
    double blend;
    WrVec3 grad_u[3], grad_v[3]; /* of the planes */
    bool *covers;                /* [triangle_count], or NULL: all */
    float (*mean)[3];            /* [corner_count] s, or NULL: not blended */
    WrField *table;              /* of the mask, or NULL */
};

/* A number or vector with its derivatives by b1 and b2. */
typedef struct Sloped {
    double x, b[2];
} Sloped;

typedef struct SlopedVector {
    WrVec3 x, b[2];
} SlopedVector;

static inline SlopedVector interpolate(const float a[3], const float b[3], const float c[3],
                                       double b1, double b2)
{
    const WrVec3 p = v3_load(a), e1 = v3_sub(v3_load(b), p), e2 = v3_sub(v3_load(c), p);
    return (SlopedVector){ v3_mad(v3_mad(p, e1, b1), e2, b2), { e1, e2 } };
}

/* x / |x|: its derivative is that of x across x, divided by |x|. */
static inline SlopedVector unit_of(SlopedVector a)
{
    const double length = v3_len(a.x);
    const WrVec3 none = { 0, 0, 0 };
    SlopedVector out = { none, { none, none } };
    if (!(length > 0)) return out;
    out.x = v3_scale(a.x, 1 / length);
    for (int k = 0; k < 2; k++)
        out.b[k] = v3_scale(v3_mad(a.b[k], out.x, -v3_dot(out.x, a.b[k])), 1 / length);
    return out;
}

static inline Sloped dot(SlopedVector a, SlopedVector b)
{
    return (Sloped){ v3_dot(a.x, b.x),
                     { v3_dot(a.b[0], b.x) + v3_dot(a.x, b.b[0]),
                       v3_dot(a.b[1], b.x) + v3_dot(a.x, b.b[1]) } };
}

/* S((x - low) / (high - low)) */
static inline Sloped smooth_step(Sloped x, double low, double high)
{
    const double t = (x.x - low) / (high - low), slope = 6 * t * (1 - t) / (high - low);
    if (!(t > 0)) return (Sloped){ 0, { 0, 0 } };
    if (t >= 1) return (Sloped){ 1, { 0, 0 } };
    return (Sloped){ t * t * (3 - 2 * t), { slope * x.b[0], slope * x.b[1] } };
}

/* ---- the direction ---- */

static WrVec3 without(WrVec3 v, WrVec3 axis)
{
    return v3_mad(v, axis, -v3_dot(v, axis));
}

/* The direction d at P. */
static inline SlopedVector way_at(const WrReliefWeights *w, WrFacing facing, SlopedVector p)
{
    const WrVec3 none = { 0, 0, 0 };
    if (facing < WR_FACING_OUT) {
        const WrVec3 axis = w->frame.axis[(facing - WR_FACING_X) % 3];
        const bool minus = facing >= WR_FACING_MINUS_X;
        return (SlopedVector){ minus ? v3_neg(axis) : axis, { none, none } };
    }
    SlopedVector r = { v3_sub(p.x, w->frame.at), { p.b[0], p.b[1] } };
    if (!w->from_centre) {
        r.x = without(r.x, w->frame.axis[2]);
        for (int k = 0; k < 2; k++) r.b[k] = without(r.b[k], w->frame.axis[2]);
    }
    r = unit_of(r);
    if (facing == WR_FACING_OUT) return r;
    return (SlopedVector){ v3_neg(r.x), { v3_neg(r.b[0]), v3_neg(r.b[1]) } };
}

static inline SlopedVector place_of(const WrTriangles *mesh, int32_t face, double b1, double b2)
{
    return interpolate(wr_triangle_corner(mesh, face, 0)->p, wr_triangle_corner(mesh, face, 1)->p,
                       wr_triangle_corner(mesh, face, 2)->p, b1, b2);
}

static Sloped facing_at(const WrTriangles *mesh, int32_t face, SlopedVector p, double b1, double b2)
{
    const WrReliefWeights *w = mesh->weights;
    if (w->facing == WR_FACING_ANY) return (Sloped){ 1, { 0, 0 } };
    const SlopedVector n = unit_of(interpolate(wr_triangle_corner(mesh, face, 0)->n,
                                               wr_triangle_corner(mesh, face, 1)->n,
                                               wr_triangle_corner(mesh, face, 2)->n, b1, b2));
    return smooth_step(dot(n, way_at(w, w->facing, p)), w->none, w->whole);
}

/* The mask table. A B-spline has no steps of its slope, which light would show. */
static Sloped table_at(const WrTriangles *mesh, int32_t face, double b1, double b2)
{
    const float(*own)[2] = mesh->mask_uv + 3 * (size_t)face;
    double uv[2], f, fu, fv, most = 0;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++) most = fmax(most, fabs((double)own[k][c]));
    if (!(most > 0)) return (Sloped){ 0, { 0, 0 } }; /* missing ones are 0 */
    wr_relief_mask_uv(mesh, face, b1, b2, uv);
    wr_field_sample(mesh->weights->table, WR_SCHEME_BSPLINE, 1, &uv[0], &uv[1], &f, &fu, &fv);
    if (!(f > 0)) return (Sloped){ 0, { 0, 0 } };
    if (f >= 1) return (Sloped){ 1, { 0, 0 } };
    Sloped m = { f, { 0, 0 } };
    for (int b = 0; b < 2; b++)
        m.b[b] = fu * ((double)own[b + 1][0] - (double)own[0][0]) +
                 fv * ((double)own[b + 1][1] - (double)own[0][1]);
    return m;
}

/* m on a covered face. */
static Sloped mask_at(const WrTriangles *mesh, int32_t face, SlopedVector p, double b1, double b2)
{
    const Sloped a = facing_at(mesh, face, p, b1, b2);
    if (!mesh->weights->table || !(a.x > 0)) return a;
    const Sloped t = table_at(mesh, face, b1, b2);
    return (Sloped){ a.x * t.x, { a.b[0] * t.x + a.x * t.b[0], a.b[1] * t.x + a.x * t.b[1] } };
}

/* Clears the faces beyond the angle, by their own normals. */
static void mark_facing(WrReliefWeights *w, const WrTriangles *mesh, WrFacing facing, double cosine)
{
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const SlopedVector p = place_of(mesh, i, 1.0 / 3, 1.0 / 3);
        const WrVec3 n = v3_unit(v3_cross(p.b[0], p.b[1]), (WrVec3){ 0, 0, 0 });
        w->covers[i] &= v3_dot(n, way_at(w, facing, p).x) >= cosine - ROUNDING;
    }
}

/* ---- materials ---- */

int wr_relief_number(const WrTriangles *mesh, int32_t part)
{
    const int32_t number = mesh->parts[part].number;
    return number > 0 ? number : part + 1;
}

bool wr_relief_lists(const char *list, const WrTriangles *mesh, int32_t part)
{
    const char *name = mesh->parts[part].name;
    char number[16];
    snprintf(number, sizeof number, "%d", wr_relief_number(mesh, part));
    for (const char *at = list; at;) {
        const char *end = strchr(at, ',');
        const size_t length = end ? (size_t)(end - at) : strlen(at);
        if ((strlen(name) == length && strncmp(at, name, length) == 0) ||
            (strlen(number) == length && strncmp(at, number, length) == 0))
            return true;
        at = end ? end + 1 : NULL;
    }
    return false;
}

/* True if some part has that name or number. */
static bool has_part(const WrTriangles *mesh, const char *name)
{
    for (int32_t i = 0; i < mesh->part_count; i++)
        if (wr_relief_lists(name, mesh, i)) return true;
    return false;
}

static bool fail_material(const WrTriangles *mesh, const char *name, WrError *err)
{
    WrText text = { 0 };
    int count = 0;
    for (int32_t i = 0; i < mesh->part_count; i++) {
        const int number = wr_relief_number(mesh, i);
        if (i > 0 && number == wr_relief_number(mesh, i - 1)) continue;
        if (count++ >= LISTED) continue;
        wr_text_addf(&text, "%s%d %s", i ? ", " : "", number,
                     *mesh->parts[i].name ? mesh->parts[i].name : "(unnamed)");
    }
    if (count > LISTED) wr_text_addf(&text, ", ... %d in all", count);
    wr_fail(err, "materials=%s: the mesh has no such material; it has %s", name,
            wr_text_get(&text));
    wr_text_fini(&text);
    return false;
}

static bool check_materials(const WrTriangles *mesh, const char *list, WrError *err)
{
    char name[WR_PROJECTION_MATERIALS];
    for (const char *at = list; at;) {
        const char *end = strchr(at, ',');
        const size_t length = end ? (size_t)(end - at) : strlen(at);
        memcpy(name, at, length);
        name[length] = '\0';
        if (!has_part(mesh, name)) return fail_material(mesh, name, err);
        at = end ? end + 1 : NULL;
    }
    return true;
}

static void mark_materials(WrReliefWeights *w, const WrTriangles *mesh, const char *list)
{
    for (int32_t i = 0; i < mesh->part_count; i++) {
        const WrTrianglePart *part = &mesh->parts[i];
        const bool listed = wr_relief_lists(list, mesh, i);
        for (int32_t k = part->first; k < part->first + part->count; k++) w->covers[k] &= listed;
    }
}

/* ---- blending ---- */

/* Mean normals of all faces about each position, weighted by their angles. */
static bool find_means(WrReliefWeights *w, const WrTriangles *mesh, WrError *err)
{
    const size_t corners = (size_t)mesh->corner_count;
    const WrVec3 none = { 0, 0, 0 };
    int32_t places = 0;
    w->mean = wr_try_alloc(corners, sizeof *w->mean, "a mesh's normals", err);
    float(*p)[3] = wr_try_alloc(corners, sizeof *p, "a mesh's normals", err);
    int32_t *place = wr_try_alloc(corners, sizeof *place, "a mesh's normals", err);
    bool good = w->mean && p && place;
    for (size_t i = 0; i < corners && good; i++) memcpy(p[i], mesh->corners[i].p, sizeof *p);
    good = good && wr_weld(p, sizeof *p, mesh->corner_count, place, &places, err);
    WrVec3 *sum = good ? wr_try_alloc((size_t)places, sizeof *sum, "a mesh's normals", err) : NULL;
    for (int32_t i = 0; i < 3 * mesh->triangle_count && sum; i++) {
        const WrVec3 at = v3_load(wr_triangle_corner(mesh, i / 3, i % 3)->p);
        const WrVec3 a = v3_sub(v3_load(wr_triangle_corner(mesh, i / 3, (i + 1) % 3)->p), at);
        const WrVec3 b = v3_sub(v3_load(wr_triangle_corner(mesh, i / 3, (i + 2) % 3)->p), at);
        WrVec3 *to = &sum[place[mesh->triangles[i / 3].corner[i % 3]]];
        *to = v3_mad(*to, v3_unit(v3_cross(a, b), none), wr_angle(a, b));
    }
    for (size_t i = 0; i < corners && sum; i++) {
        const WrVec3 s = v3_unit(sum[place[i]], v3_load(mesh->corners[i].n));
        w->mean[i][0] = (float)s.x, w->mean[i][1] = (float)s.y, w->mean[i][2] = (float)s.z;
    }
    good = sum != NULL;
    wr_free(sum);
    wr_free(place);
    wr_free(p);
    return good;
}

/* w[k], and the signs of s[k]. */
static void shares_at(const WrReliefWeights *w, SlopedVector s, Sloped share[3], double sign[3])
{
    Sloped part[3], sum = { 0, { 0, 0 } };
    int most = 0;
    for (int k = 0; k < 3; k++) {
        const double x = v3_dot(s.x, w->frame.axis[k]);
        sign[k] = x < 0 ? -1 : 1;
        part[k].x = fabs(x);
        for (int b = 0; b < 2; b++) part[k].b[b] = sign[k] * v3_dot(s.b[b], w->frame.axis[k]);
        if (part[k].x > part[most].x) most = k;
    }
    const Sloped top = part[most];
    for (int k = 0; k < 3; k++) {
        Sloped t = { 1, { 0, 0 } };
        if (top.x > 0) {
            t.x = part[k].x / top.x;
            for (int b = 0; b < 2; b++) t.b[b] = (part[k].b[b] - t.x * top.b[b]) / top.x;
        }
        share[k] = smooth_step(t, 1 - w->blend, 1);
        sum.x += share[k].x;
        for (int b = 0; b < 2; b++) sum.b[b] += share[k].b[b];
    }
    for (int k = 0; k < 3; k++) {
        share[k].x /= sum.x;
        for (int b = 0; b < 2; b++) share[k].b[b] = (share[k].b[b] - share[k].x * sum.b[b]) / sum.x;
    }
}

/* The planes' gradients of u and v on the side of the axes (projection.h). */
static void set_gradients(WrReliefWeights *w, const double cell[2])
{
    const WrVec3 *axis = w->frame.axis;
    const double du = w->frame.scale / cell[0], dv = w->frame.scale / cell[1];
    const WrVec3 u[3] = { axis[1], v3_neg(axis[0]), axis[0] }, v[3] = { axis[2], axis[2], axis[1] };
    for (int k = 0; k < 3; k++)
        w->grad_u[k] = v3_scale(u[k], du), w->grad_v[k] = v3_scale(v[k], dv);
}

static void set_planes(const WrTriangles *mesh, int32_t face, SlopedVector p, double b1, double b2,
                       WrReliefTap taps[3])
{
    const WrReliefWeights *w = mesh->weights;
    const int32_t *c = mesh->triangles[face].corner;
    Sloped share[3];
    double sign[3];
    shares_at(w, interpolate(w->mean[c[0]], w->mean[c[1]], w->mean[c[2]], b1, b2), share, sign);
    const WrVec3 q = v3_sub(p.x, w->frame.at);
    for (int k = 0; k < 3; k++) {
        const WrVec3 gu = w->grad_u[k], gv = w->grad_v[k];
        taps[k] = (WrReliefTap){
            .u = sign[k] * v3_dot(q, gu),
            .v = v3_dot(q, gv),
            .weight = share[k].x,
            .u_b = { sign[k] * v3_dot(p.b[0], gu), sign[k] * v3_dot(p.b[1], gu) },
            .v_b = { v3_dot(p.b[0], gv), v3_dot(p.b[1], gv) },
            .weight_b = { share[k].b[0], share[k].b[1] },
        };
    }
}

/* ---- the whole ---- */

bool wr_relief_is_weighted(const WrProjection *is)
{
    return is->facing != WR_FACING_ANY || *is->materials ||
           (is->kind == WR_PROJECTION_BOX && is->blend > 0);
}

static double cosine_of(double deg)
{
    double sine, cosine;
    wr_sincos_turns(fmin(deg, 180) / 360, &sine, &cosine);
    return cosine;
}

WrReliefWeights *wr_relief_weights_new(const WrTriangles *mesh, const WrProjection *is,
                                       const WrProjectionFrame *frame, const WrField *mask,
                                       WrError *err)
{
    const bool hard = is->facing != WR_FACING_ANY && !(is->facing_soft_deg > 0);
    const bool blended = is->kind == WR_PROJECTION_BOX && is->blend > 0;
    if (*is->materials && !check_materials(mesh, is->materials, err)) return NULL;
    WrReliefWeights *w = wr_alloc(1, sizeof *w);
    *w = (WrReliefWeights){ .frame = *frame,
                            .from_centre = is->kind == WR_PROJECTION_SPHERICAL,
                            .facing = hard ? WR_FACING_ANY : is->facing,
                            .whole = cosine_of(is->facing_deg),
                            .none = cosine_of(is->facing_deg + is->facing_soft_deg),
                            .blend = is->blend,
                            .table = mask ? wr_field_share(mask) : NULL };
    set_gradients(w, is->cell);
    bool good = true;
    if (hard || *is->materials) {
        w->covers =
            wr_try_alloc((size_t)mesh->triangle_count, sizeof *w->covers, "a mesh's mask", err);
        good = w->covers != NULL;
        if (good) memset(w->covers, true, (size_t)mesh->triangle_count * sizeof *w->covers);
    }
    if (good && hard) mark_facing(w, mesh, is->facing, w->whole);
    if (good && *is->materials) mark_materials(w, mesh, is->materials);
    if (good && (!blended || find_means(w, mesh, err))) return w;
    wr_relief_weights_free(w);
    return NULL;
}

void wr_relief_weights_free(WrReliefWeights *w)
{
    if (!w) return;
    wr_free(w->covers);
    wr_free(w->mean);
    wr_field_free(w->table);
    wr_free(w);
}

bool wr_relief_is_blended(const WrTriangles *mesh)
{
    return mesh->weights && mesh->weights->mean;
}

bool wr_relief_covers(const WrTriangles *mesh, int32_t face)
{
    return !mesh->weights || !mesh->weights->covers || mesh->weights->covers[face];
}

const WrField *wr_relief_mask(const WrTriangles *mesh)
{
    return mesh->weights ? mesh->weights->table : NULL;
}

void wr_relief_mask_uv(const WrTriangles *mesh, int32_t face, double b1, double b2, double uv[2])
{
    const float(*own)[2] = mesh->mask_uv + 3 * (size_t)face;
    for (int c = 0; c < 2; c++)
        uv[c] = (double)own[0][c] + b1 * ((double)own[1][c] - (double)own[0][c]) +
                b2 * ((double)own[2][c] - (double)own[0][c]);
}

int wr_relief_taps(const WrTriangles *mesh, int32_t face, double b1, double b2,
                   WrReliefTap taps[WR_RELIEF_TAPS])
{
    if (!wr_relief_covers(mesh, face)) return 0;
    const SlopedVector p = place_of(mesh, face, b1, b2);
    const Sloped mask = mask_at(mesh, face, p, b1, b2);
    if (!(mask.x > 0)) return 0;
    int count = 1;
    if (wr_relief_is_blended(mesh)) {
        set_planes(mesh, face, p, b1, b2, taps);
        count = 3;
    } else {
        const WrTriangleCorner *c[3];
        for (int k = 0; k < 3; k++) c[k] = wr_triangle_corner(mesh, face, k);
        const double u = (double)c[0]->u, u1 = (double)c[1]->u - u, u2 = (double)c[2]->u - u;
        const double v = (double)c[0]->v, v1 = (double)c[1]->v - v, v2 = (double)c[2]->v - v;
        taps[0] = (WrReliefTap){ .u = u + b1 * u1 + b2 * u2,
                                 .v = v + b1 * v1 + b2 * v2,
                                 .weight = 1,
                                 .u_b = { u1, u2 },
                                 .v_b = { v1, v2 } };
    }
    for (int k = 0; k < count; k++) {
        for (int b = 0; b < 2; b++)
            taps[k].weight_b[b] = taps[k].weight_b[b] * mask.x + taps[k].weight * mask.b[b];
        taps[k].weight *= mask.x;
    }
    return count;
}

void wr_relief_add(WrReliefSum *sum, const WrReliefTap *tap, double f, double fu, double fv)
{
    sum->f += tap->weight * f;
    for (int b = 0; b < 2; b++)
        sum->f_b[b] += tap->weight * (fu * tap->u_b[b] + fv * tap->v_b[b]) + tap->weight_b[b] * f;
    sum->fu += tap->weight * fu;
    sum->fv += tap->weight * fv;
}

/* f_b = fu u_b + fv v_b for both b: Cramer's rule. */
void wr_relief_slopes(const WrTriangles *mesh, int32_t face, const WrReliefSum *sum, double *fu,
                      double *fv)
{
    const WrTriangleCorner *a = wr_triangle_corner(mesh, face, 0),
                           *b = wr_triangle_corner(mesh, face, 1),
                           *c = wr_triangle_corner(mesh, face, 2);
    const double u1 = (double)b->u - (double)a->u, u2 = (double)c->u - (double)a->u;
    const double v1 = (double)b->v - (double)a->v, v2 = (double)c->v - (double)a->v;
    const double det = u1 * v2 - u2 * v1;
    const bool flat = !(fabs(det) > WR_COLLINEAR * (fabs(u1 * v2) + fabs(u2 * v1)));
    *fu = flat ? sum->fu : (sum->f_b[0] * v2 - sum->f_b[1] * v1) / det;
    *fv = flat ? sum->fv : (sum->f_b[1] * u1 - sum->f_b[0] * u2) / det;
}
