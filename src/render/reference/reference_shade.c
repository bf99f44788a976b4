#include "render/reference/reference_shade.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "field/analytic.h"
#include "field/field.h"
#include "image/image.h"
#include "noise/octaves.h"
#include "render/reference/reference_relief.h"
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "shade/bump.h"
#include "shade/reflection.h"
#include "shade/reflection_models.h"
#include "shade/solid_texture.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <math.h>

/* ---- shadows of objects ---- */

/* The reference evaluates each term by its definition: rays for shadows, sums over directions for the
   surroundings, marches for relief. It shares data and surface formulas with the renderer, but no kernel, so
   that equal errors are unlikely. */

static const double pi = 3.14159265358979323846;

#define LAMP_POINTS 64 /* points on an area lamp */
#define ABOVE 1e-7     /* of the object's radius: height of the rays' origin above the surface */

/* Casters hide from both sides and with all their faces: culling and hidden faces are rules of the camera's
   view. */
void wr_reference_caster(WrReferenceCaster *caster, const WrReferenceStage *stage)
{
    *caster = (WrReferenceCaster){ stage->view, stage };
    caster->view.cull = caster->view.beyond = false;
    for (int k = 0; k < 6; k++) caster->view.hidden[k] = false;
}

static WrVec3 to_world(const WrReferenceView *view, WrVec3 w)
{
    const double *m = view->rotation;
    return (WrVec3){ m[0] * w.x + m[1] * w.y + m[2] * w.z, m[3] * w.x + m[4] * w.y + m[5] * w.z,
                     m[6] * w.x + m[7] * w.y + m[8] * w.z };
}

/* The triangle's geometric normal, which is not its shading normal. */
static WrVec3 flat_normal(const WrTriangles *t, int32_t triangle, WrVec3 n)
{
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *from = t->corners[t->triangles[triangle].corner[k]].p;
        p[k] = (WrVec3){ (double)from[0], (double)from[1], (double)from[2] };
    }
    return v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])), n);
}

/* The surface's normal on the visible side, in world proportions. */
static WrVec3 outward(const WrReferenceStage *stage, const WrSurfacePoint *at,
                      const WrReferenceHit *hit, WrVec3 perturbed)
{
    const WrReferenceView *view = &stage->view;
    WrSurfacePoint flat = *at;
    if (stage->raised.count > 0) return perturbed;
    if (view->info->held && !view->bezier.source)
        flat.n_unit = flat_normal(view->mesh.source, hit->triangle, at->n_unit);
    return wr_reference_normal_stretched(view,
                                         v3_scale(flat.n_unit, wr_reference_side(view, &flat)));
}

/* Rays may have any length; the direction is divided by the caster's size, so that the parameter stays the
   distance in world units and hits of all casters compare with `away`. */
static bool meets(const WrReferenceCaster *caster, WrVec3 from, WrVec3 l, double away)
{
    const WrPlacement *place = &caster->view.place;
    const WrReferenceRay ray = { wr_world_to_object(place, from),
                                 v3_scale(wr_place_shrink_back(place, l), 1 / place->size), 0 };
    WrReferenceHit hit;
    const bool met = caster->stage->raised.count > 0
                         ? wr_reference_raised_hit(&caster->stage->raised, &ray, &hit)
                         : wr_reference_view_hit(&caster->view, &ray, &hit);
    return met && hit.s < away;
}

/* A bumped normal may face a lamp that the surface itself turns away from (HC25). A ray towards it would start
   into the object's own body; for the own caster it is turned into the tangent plane, so that only real
   obstacles count. Whether such a point is lit at all is the reflection model's decision. */
static bool is_blocked(const WrReferenceStage *stage, WrVec3 from, WrVec3 n, WrVec3 l, double away)
{
    const double up = v3_dot(n, l);
    const WrVec3 level = up < 0 ? v3_mad(l, n, -up) : l;
    for (int i = 0; i < stage->caster_count; i++) {
        const WrReferenceCaster *caster = &stage->casters[i];
        const bool own = caster->stage == stage;
        /* computed by the relief's own shadows */
        if (own && stage->raised.count > 0 && stage->shadow > 0) continue;
        if (meets(caster, from, own ? level : l, away)) return true;
    }
    return false;
}

/* Visible share of a lamp past all objects. l: unit vector to it, along the object's axes, and away, its
   distance, both in world proportions; radius: of an area lamp, radians, of whose points each sample uses its
   share. Below the surface's own horizon the object itself is tested along the horizon.
   Area lamps: point k of 64 lies at radius sqrt((k + 1/2) / 64) and at k times the golden angle, an even
   spread over the disc. share.of samples of one pixel use every share.of-th point each; together they use all. */
static double reference_cast_share(const WrReferenceStage *stage, const WrSurfacePoint *at,
                                   const WrReferenceHit *hit, WrVec3 perturbed, WrVec3 l,
                                   double away, double radius, WrReferenceShare share)
{
    const WrReferenceView *view = &stage->view;
    const WrVec3 n = to_world(view, outward(stage, at, hit, perturbed)), to = to_world(view, l);
    const double far = away * view->size;
    /* with parallax, the point on the base, which is the shadow caster */
    WrSurfacePoint foot = *at;
    if (stage->parallax) wr_reference_surface_point(view, hit, &foot);
    const WrVec3 p = wr_object_to_world(&view->place, foot.p);
    const WrVec3 from = v3_mad(p, n, ABOVE * view->place.radius * view->size);
    if (!(radius > 0)) return is_blocked(stage, from, n, to, far) ? 0 : 1;
    const WrVec3 least = fabs(to.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 a = v3_unit(v3_cross(to, least), least), b = v3_cross(to, a);
    int seen = 0, all = 0;
    for (int k = share.part % LAMP_POINTS; k < LAMP_POINTS; k += share.of) {
        const double r = tan(radius) * sqrt((k + 0.5) / LAMP_POINTS),
                     turn = 2.39996322972865332 * k;
        const WrVec3 aside = v3_mad(v3_scale(a, cos(turn)), b, sin(turn));
        seen += !is_blocked(stage, from, n, v3_unit(v3_mad(to, aside, r), to), far);
        all++;
    }
    return (double)seen / all;
}

/* ---- environment light ---- */

/* Diffuse light: the sphere is cut in ACROSS x DOWN equal steps of longitude and latitude, each replaced by
   one lamp at its brightness-weighted mean direction. A lamp of strength 1 yields pi f (n.l) (NUMERICS-LIGHT),
   hence rgb = light * solid angle / pi. */

/* Parts of the sphere for the sum of diffuse light: so small that a cosine is nearly linear over each. */
#define ACROSS 96
#define DOWN 48
#define FACETS WR_REFERENCE_FACETS
#define FINE 4 /* sample points a side in each part of a small picture */

static int wrapped(int i, int count)
{
    return (i % count + count) % count;
}

/* Rows beyond a pole: the row at the pole is reflected through its mean, 2 mean - own. The bilinear value at
   the pole itself is then the mean of the row, for every longitude (HC111). */
static double texel(const WrEnvironmentMap *s, int column, int row, int c)
{
    const WrImage *image = s->image;
    const float *data = image->data;
    const int w = image->width, h = image->height, near = row < 0 ? 0 : row >= h ? h - 1 : row;
    const double own =
        (double)data[3 * ((size_t)near * (size_t)w + (size_t)wrapped(column, w)) + (size_t)c];
    double mean = 0;
    if (row == near) return own;
    for (int i = 0; i < w; i++)
        mean += (double)data[3 * ((size_t)near * (size_t)w + (size_t)i) + (size_t)c] / w;
    return 2 * mean - own;
}

/* Bilinear fetch; longitude -pi..pi from -z to +x, latitude. */
static void look(const WrEnvironmentMap *s, double longitude, double latitude, double rgb[3])
{
    const double x = (longitude / (2 * pi) + 0.5) * s->image->width - 0.5;
    const double y = (0.5 - latitude / pi) * s->image->height - 0.5;
    const double a = x - floor(x), b = y - floor(y);
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0;
        for (int k = 0; k < 4; k++)
            rgb[c] += (k & 1 ? a : 1 - a) * (k & 2 ? b : 1 - b) *
                      texel(s, (int)floor(x) + (k & 1), (int)floor(y) + (k >> 1), c);
    }
}

static WrVec3 direction(double longitude, double latitude)
{
    return (WrVec3){ sin(longitude) * cos(latitude), sin(latitude),
                     -cos(longitude) * cos(latitude) };
}

/* Converts one of the picture's directions, rotated by the user's turn, to the object's axes. */
static WrVec3 along(const double rotation[9], double turn_deg, WrVec3 d)
{
    const double t = fmod(turn_deg, 360) * pi / 180, c = cos(t), s = sin(t);
    const WrVec3 w = { d.x * c + d.z * s, d.y, d.z * c - d.x * s };
    return (WrVec3){ rotation[0] * w.x + rotation[3] * w.y + rotation[6] * w.z,
                     rotation[1] * w.x + rotation[4] * w.y + rotation[7] * w.z,
                     rotation[2] * w.x + rotation[5] * w.y + rotation[8] * w.z };
}

/* n x m sample points of one part: its light, and its mean direction.
   The solid angle of a cell of the sampling grid is (4 pi / W) sin(pi / 2H) cos(latitude): exact, so the sum
   is 4 pi. */
static void sum_sector(const WrEnvironmentMap *s, int i, int j, int n, int m,
                       WrReferenceSector *out)
{
    WrVec3 sum = { 0, 0, 0 };
    double rgb[3] = { 0 };
    for (int k = 0; k < n * m; k++) {
        const double longitude = 2 * pi * (((k % n + 0.5) / n + i) / ACROSS - 0.5);
        const double latitude = pi * (0.5 - ((k / n + 0.5) / m + j) / DOWN);
        /* exact solid angle */
        const double angle = 4 * pi / (ACROSS * n) * sin(pi / (2 * DOWN * m)) * cos(latitude);
        double l[3];
        look(s, longitude, latitude, l);
        for (int c = 0; c < 3; c++) rgb[c] += l[c] * angle;
        sum = v3_mad(sum, direction(longitude, latitude), (l[0] + l[1] + l[2]) * angle);
    }
    const WrVec3 middle =
        direction(2 * pi * ((i + 0.5) / ACROSS - 0.5), pi * (0.5 - (j + 0.5) / DOWN));
    out->where = v3_unit(sum, middle);
    for (int c = 0; c < 3; c++) out->rgb[c] = rgb[c];
}

/* At least one sample per texel, so that a sun of a few texels is not missed (HC113). */
static int places(int texels, int parts)
{
    const int n = (texels + parts - 1) / parts;
    return n < FINE ? FINE : n;
}

/* Prepares the environment. rotation: the object's axes -> the world. */
static void reference_surround_init(WrReferenceSurround *surround, const WrScene *scene,
                                    const double rotation[9])
{
    const WrEnvironment *e = &scene->environment;
    *surround = (WrReferenceSurround){ 0 };
    if (!e->light) return;
    for (int i = 0; i < 9; i++) surround->rotation[i] = rotation[i];
    const double turn = fmod(e->turn_deg, 360) * pi / 180;
    surround->turn[0] = cos(turn), surround->turn[1] = sin(turn);
    for (int i = 0; i < FACETS; i++) {
        const double a = 2 * pi * (i + 0.5) / FACETS;
        surround->around[i][0] = cos(a), surround->around[i][1] = sin(a);
    }
    const WrImage *image = e->light->image;
    const int n = places(image->width, ACROSS), m = places(image->height, DOWN);
    surround->sectors = wr_alloc(ACROSS * DOWN, sizeof *surround->sectors);
    for (int j = 0; j < DOWN; j++)
        for (int i = 0; i < ACROSS; i++) {
            WrReferenceSector *out = &surround->sectors[surround->count++];
            sum_sector(e->light, i, j, n, m, out);
            out->where = along(rotation, e->turn_deg, out->where);
            for (int c = 0; c < 3; c++) out->rgb[c] *= e->strength / pi;
        }
}

/* Prepares the environment. rotation: the object's axes -> the world. */
static void reference_surround_fini(WrReferenceSurround *surround)
{
    wr_free(surround->sectors);
    *surround = (WrReferenceSurround){ 0 };
}

/* True if the part at that column and row of a grid belongs to the share. Neighbours belong to other shares.
   7 rows apart the same column belongs to the same share again: each share covers the sphere evenly. */
static bool takes(WrReferenceShare share, int column, int row)
{
    return (column + 7 * row) % share.of == share.part;
}

/* Diffuse light: each part of the sphere is a lamp. */
static void add_diffuse(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n, WrVec3 v,
                        const double colour[3], WrReferenceShare share, double own[3])
{
    const WrMaterial *m = &stage->scene->material;
    const WrReferenceSurround *from = &stage->surround;
    WrMatter matter = *is;
    WrMaterial only = *m;
    matter.ks = only.specular = 0;
    for (int i = 0; i < from->count; i++) {
        if (!takes(share, i % ACROSS, i / ACROSS)) continue;
        const WrReferenceSector *sector = &from->sectors[i];
        double one[3], white;
        if (!(v3_dot(n, sector->where) > 0)) continue;
        wr_reference_lamp(&only, &matter, n, sector->where, v, colour, one, &white);
        for (int c = 0; c < 3; c++) own[c] += share.of * one[c] * sector->rgb[c];
    }
}

/* Light from a direction, given along the object's axes. */
static void look_along(const WrReferenceStage *stage, WrVec3 d, double rgb[3])
{
    const WrEnvironment *e = &stage->scene->environment;
    const double *r = stage->surround.rotation;
    const WrVec3 w = { r[0] * d.x + r[1] * d.y + r[2] * d.z, r[3] * d.x + r[4] * d.y + r[5] * d.z,
                       r[6] * d.x + r[7] * d.y + r[8] * d.z };
    const double *turn = stage->surround.turn; /* cosine, sine */
    const double x = w.x * turn[0] - w.z * turn[1], z = w.x * turn[1] + w.z * turn[0];
    look(e->light, atan2(x, -z), atan2(w.y, sqrt(x * x + z * z)), rgb);
    for (int c = 0; c < 3; c++) rgb[c] *= e->strength;
}

/* Width of the lobe from which facet directions are sampled. */
static double width_of(const WrMaterial *m, const WrMatter *matter)
{
    return wr_reflects[m->model].shininess ? sqrt(2 / (m->shininess + 2)) : matter->alpha;
}

/* Highlights: facets h, weighted by their distribution; each mirrors the light from 2 (v.h) h - v.
   The facets' distribution is GGX's with alpha = width_of, whatever the model; it only sets where samples lie.
   With c = n.h, w = 1 + c^2 (a^2 - 1) and D = a^2 / (pi w^2), the density of l is D c / (4 v.h), so a sample
   counts
       pi f (n.l) L / pi / density = 4 (v.h) w^2 / (a^2 c) * (pi f (n.l)) L.
   c comes from x in 0..1 by c^2 = (1 - x) / (1 + x (a^2 - 1)); x = t^2 (3 - 2t) with dx = 6 t (1 - t) dt
   places more samples at both ends, where the integrand changes fastest. The points form a regular grid: no
   random numbers, same bits always. */
static void add_shine(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n, WrVec3 v,
                      const double colour[3], WrReferenceShare part, double own[3], double white[3])
{
    const double short_of =
        fmax(0, 1e-3 - v3_dot(n, v)); /* facets are distributed around the visible normal */
    const WrVec3 seen = v3_unit(v3_mad(n, v, short_of), n);
    WrMatter matter = *is;
    WrMaterial only = stage->scene->material;
    matter.kd = only.diffuse = 0;
    const double alpha = width_of(&only, &matter), a2 = alpha * alpha;
    const WrVec3 other = fabs(seen.x) < 0.5 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 e = v3_unit(v3_cross(seen, other), other), f = v3_cross(seen, e);
    for (int i = 0; i < FACETS * FACETS; i++) {
        if (!takes(part, i % FACETS, i / FACETS)) continue;
        const double t = (i / FACETS + 0.5) / FACETS, x = t * t * (3 - 2 * t);
        const double *turn = stage->surround.around[i % FACETS];
        const double c = sqrt((1 - x) / (1 + x * (a2 - 1))), s = sqrt(fmax(0, 1 - c * c));
        const WrVec3 h =
            v3_add(v3_scale(seen, c), v3_add(v3_scale(e, s * turn[0]), v3_scale(f, s * turn[1])));
        const double vh = v3_dot(v, h), w = 1 + c * c * (a2 - 1);
        if (!(vh > 0)) continue;
        const double share =
            part.of * 4 * vh * w * w / (a2 * c) * 6 * t * (1 - t) / (FACETS * FACETS);
        const WrVec3 l = v3_sub(v3_scale(h, 2 * vh), v);
        double one[3], shine, rgb[3];
        wr_reference_lamp(&only, &matter, n, l, v, colour, one, &shine);
        if (one[0] == 0 && shine == 0) continue;
        look_along(stage, l, rgb);
        for (int k = 0; k < 3; k++)
            own[k] += share * one[k] * rgb[k], white[k] += share * shine * rgb[k];
    }
}

/* Adds the environment's light: `own` is multiplied by the surface's colour, `white` by none. is: the material
   there; n: facing the viewer; colour: as in reference_reflect. */
static void reference_surround_light(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n,
                                     WrVec3 v, const double colour[3], WrReferenceShare share,
                                     double own[3], double white[3])
{
    const WrMaterial *m = &stage->scene->material;
    for (int c = 0; c < 3; c++) own[c] = white[c] = 0;
    if (stage->surround.count == 0) return;
    const bool metal = wr_reflects[m->model].metalness && is->metal == 1;
    if (m->diffuse != 0 && !metal) add_diffuse(stage, is, n, v, colour, share, own);
    if (m->specular != 0 && wr_reflects[m->model].shines)
        add_shine(stage, is, n, v, colour, share, own, white);
}

/* ---- shading ---- */

typedef struct WrReferenceStage WrReferenceStage;
typedef struct WrSurfacePoint WrSurfacePoint;

/* ---- reference occlusion ---- */

#define DISC 48  /* points on an area lamp */
#define ROUND 48 /* directions around a point */

/* True if the ray to the lamp hits the displaced surface before the lamp. */
static bool meets_relief(const WrReferenceStage *stage, WrVec3 p, WrVec3 perturbed, WrVec3 l,
                         double away)
{
    const WrReferenceRay ray = { v3_mad(p, perturbed, 1e-7 * stage->raised.size), l, 0 };
    WrReferenceHit hit;
    return wr_reference_raised_hit(&stage->raised, &ray, &hit) && hit.s < away;
}

/* True if the relief hides a lamp in direction l. Above the tangent plane the ray rises by n.l per length, and
   (a, b) is its motion in u and v: it is marched in steps of an eighth of a texel until it is above everything.
   (a, b) is the inverse of the first fundamental form applied to (l.Pu, l.Pv). The march ends when t n.l
   exceeds the whole range of heights (`shadow`), or after four periods. The base is treated as its tangent
   plane along the way. */
static bool is_hidden(const WrReferenceStage *stage, const WrSurfacePoint *at, double u, double v,
                      WrVec3 l)
{
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double lu = v3_dot(l, at->pu), lv = v3_dot(l, at->pv), det = e * g - f * f;
    const double up = v3_dot(l, at->n_unit);
    if (!(det > 0) || wr_reference_side(&stage->view, at) < 0) return false;
    if (up < 0) return true;
    const double a = (g * lu - f * lv) / det, b = (e * lv - f * lu) / det;
    const double moves = hypot(a * stage->texels[0], b * stage->texels[1]);
    const double farthest = 4 * (stage->texels[0] + stage->texels[1]);
    double from, fu, fv, here;
    wr_reference_height(stage, u, v, &from, &fu, &fv);
    for (double way = 0.125; moves > 0 && way < farthest; way += 0.125) {
        const double t = way / moves;
        if (t * up > stage->shadow) return false;
        wr_reference_height(stage, u + t * a, v + t * b, &here, &fu, &fv);
        if (here - from > t * up) return true;
    }
    return false;
}

static bool hides(const WrReferenceStage *stage, const WrSurfacePoint *at, double u, double v,
                  WrVec3 perturbed, WrVec3 l, double away)
{
    return stage->raised.count > 0 ? meets_relief(stage, at->p, perturbed, l, away)
                                   : is_hidden(stage, at, u, v, l);
}

/* Two unit vectors perpendicular to d. */
static void across(WrVec3 d, WrVec3 *a, WrVec3 *b)
{
    const WrVec3 least = fabs(d.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    *a = v3_unit(v3_cross(d, least), (WrVec3){ 0, 0, 1 });
    *b = v3_cross(d, *a);
}

/* Visible share of a lamp in direction l. radius: of an area lamp, angular; away: its distance. perturbed: n'
   facing the viewer; share: of the lamp's sample points. */
static double reference_lamp_share(const WrReferenceStage *stage, const WrSurfacePoint *at,
                                   double u, double v, WrVec3 perturbed, WrVec3 l, double away,
                                   double radius, WrReferenceShare share)
{
    if (!(radius > 0)) return hides(stage, at, u, v, perturbed, l, away) ? 0 : 1;
    WrVec3 a, b;
    int seen = 0, all = 0;
    across(l, &a, &b);
    for (int k = share.part % DISC; k < DISC;
         k += share.of, all++) { /* evenly spread over the disc, by the golden angle */
        const double r = radius * sqrt((k + 0.5) / DISC), turn = 2.39996322972865 * k;
        const WrVec3 side = v3_mad(v3_scale(a, cos(turn)), b, sin(turn));
        const WrVec3 to = v3_mad(v3_scale(l, cos(r)), side, sin(r));
        seen += !hides(stage, at, u, v, perturbed, to, away);
    }
    return (double)seen / all;
}

/* Tangent of the horizon's elevation along w, a unit vector in the tangent plane: marched in quarters of a texel
   until nothing can be higher.
   It ends when even the largest remaining rise could not exceed the best slope: t best > range. */
static double horizon_along(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                            double v, WrVec3 w)
{
    const double e = v3_dot(at->pu, at->pu), f = v3_dot(at->pu, at->pv), g = v3_dot(at->pv, at->pv);
    const double wu = v3_dot(w, at->pu), wv = v3_dot(w, at->pv), det = e * g - f * f;
    if (!(det > 0)) return 0;
    const double a = (g * wu - f * wv) / det, b = (e * wv - f * wu) / det;
    const double moves = hypot(a * stage->texels[0], b * stage->texels[1]);
    double from, fu, fv, here, best = 0;
    wr_reference_height(stage, u, v, &from, &fu, &fv);
    for (double way = 0.25; moves > 0 && way < stage->texels[0] + stage->texels[1]; way += 0.25) {
        const double t = way / moves;
        if (t * best > stage->relief) break;
        wr_reference_height(stage, u + t * a, v + t * b, &here, &fu, &fv);
        best = fmax(best, (here - from) / t);
    }
    return best;
}

/* Unoccluded share of the sky's light.
   With h the horizon's elevation in azimuth phi, n_z = n.n0 and n_phi the component of n along w
   (NUMERICS-LIGHT d):
       AO = 1/pi sum of [n_z cos^2 h / 2 + n_phi ((pi/2 - h)/2 - sin(2h)/4)] dphi;
   h is at least the elevation where the hemisphere of n begins, atan2(-n_phi, n_z). */
static double reference_open(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                             double v, WrVec3 perturbed)
{
    WrVec3 a, b;
    const WrVec3 n = wr_reference_side(&stage->view, at) < 0 ? v3_neg(perturbed) : perturbed;
    const double up = v3_dot(n, at->n_unit);
    double sum = 0;
    across(at->n_unit, &a, &b);
    for (int k = 0; k < ROUND; k++) {
        const double phi = 2 * WR_PI * (k + 0.5) / ROUND;
        const WrVec3 w = v3_mad(v3_scale(a, cos(phi)), b, sin(phi));
        const double out = v3_dot(n, w);
        const double h = fmax(atan(horizon_along(stage, at, u, v, w)), atan2(-out, up));
        sum += up * cos(h) * cos(h) / 2 + out * ((WR_PI / 2 - h) / 2 - sin(2 * h) / 4);
    }
    return fmin(fmax(2 * sum / ROUND, 0), 1);
}

/* ---- reference solid texture ---- */

static double fraction(double t)
{
    return t - floor(t);
}

/* Value of a pattern as a function of one number, and its slope. */
typedef struct Rise {
    double value, slope;
} Rise;

/* Total length of the pulses 1 - d .. 1 of all turns, from 0 to t. */
static double pulses(double t, double d)
{
    return floor(t) * d + fmax(0, fraction(t) - (1 - d));
}

static double pulse(double t, double d)
{
    return fraction(t) >= 1 - d ? 1 : 0;
}

/* Pulses, or their mean over an edge.
   The mean over a window is the difference of an integral at its ends; its slope is the difference of the
   pulse at its ends. Whole turns are removed first: at t = 1e6 the difference of the integral would have no
   digits left (HC118). */
static Rise ring(double t, double d, double edge)
{
    if (!(edge > 0)) return (Rise){ pulse(t, d), 0 };
    const double f = fraction(t), low = f - edge / 2, high = f + edge / 2;
    return (Rise){ (pulses(high, d) - pulses(low, d)) / edge,
                   (pulse(high, d) - pulse(low, d)) / edge };
}

static Rise ramp(double t)
{
    return (Rise){ fmin(fmax(t, 0), 1), t > 0 && t < 1 ? 1 : 0 };
}

static Rise wave(double t)
{
    const double turn = 2 * WR_PI * fraction(t);
    return (Rise){ 0.5 + 0.5 * sin(turn), WR_PI * cos(turn) };
}

/* Checker of cubes: odd cells along one axis are 1, even ones 0.
   (1 - s_x s_y s_z) / 2 with s = 1 - 2 odd, odd the share of odd cells in the window; exact for axis-aligned
   boxes. */
static double board(const WrSolidTexture *grain, double edge, const double p[3], double slope[3])
{
    double side[3], rise[3];
    for (int a = 0; a < 3; a++) {
        const Rise odd = ring(grain->rings * p[a] / 2, 0.5, edge / 2);
        side[a] = 1 - 2 * odd.value;
        rise[a] = -grain->rings * odd.slope;
    }
    for (int a = 0; a < 3; a++) slope[a] = -0.5 * rise[a] * side[(a + 1) % 3] * side[(a + 2) % 3];
    return 0.5 - 0.5 * side[0] * side[1] * side[2];
}

/* Argument of the pattern, with its slope: noise, and rings or bands.
   t = k rho + A noise (wood, rho the distance from the axis) or k z + A noise (marble). The gradient of rho is
   0 / 0 on the axis and counts as 0 there (HC117). */
static double place(const WrSolidTexture *grain, const WrOctavesPlan *noise, const double p[3],
                    double slope[3])
{
    const int x = (grain->axis + 1) % 3, y = (grain->axis + 2) % 3, z = grain->axis;
    const double amount = grain->kind == WR_SOLID_TEXTURE_NOISE ? grain->amount / 2 : grain->amount;
    double t = 0, by[3] = { 0, 0, 0 };
    if (wr_grains[grain->kind].noisy && amount != 0) t = amount * wr_octaves_at(noise, p, by);
    for (int a = 0; a < 3; a++) slope[a] = amount * by[a];
    if (grain->kind == WR_SOLID_TEXTURE_NOISE) return 0.5 + t;
    if (grain->kind == WR_SOLID_TEXTURE_MARBLE) {
        slope[z] += grain->rings;
        return grain->rings * p[z] + t;
    }
    if (grain->kind != WR_SOLID_TEXTURE_WOOD) return t;
    const double from = hypot(p[x], p[y]);
    if (from > 0) slope[x] += grain->rings * p[x] / from, slope[y] += grain->rings * p[y] / from;
    return grain->rings * from + t;
}

static Rise pattern(const WrSolidTexture *grain, double edge, double t)
{
    switch (grain->kind) {
    case WR_SOLID_TEXTURE_WOOD: return ring(t, grain->share, edge);
    case WR_SOLID_TEXTURE_MARBLE: return wave(t);
    case WR_SOLID_TEXTURE_GRANITE:
    case WR_SOLID_TEXTURE_NOISE: return ramp(t);
    case WR_SOLID_TEXTURE_CHECKER:
    case WR_SOLID_TEXTURE_OFF:
    case WR_SOLID_TEXTURE_KINDS: break;
    }
    return (Rise){ 0, 0 };
}

/* The pattern at a point of the object, scene units, 0..1, and its slope per scene unit. noise: from
   wr_solid_texture_noise; slope NULL: not requested. */
static double reference_grain(const WrSolidTexture *grain, const WrOctavesPlan *noise, WrVec3 p,
                              WrVec3 *slope)
{
    const double at[3] = { p.x, p.y, p.z }, edge = wr_solid_texture_edge(grain);
    double by[3], value;
    if (grain->kind == WR_SOLID_TEXTURE_CHECKER) {
        value = board(grain, edge, at, by);
    } else {
        const Rise got = pattern(grain, edge, place(grain, noise, at, by));
        value = got.value;
        for (int a = 0; a < 3; a++) by[a] *= got.slope;
    }
    if (slope) *slope = (WrVec3){ by[0], by[1], by[2] };
    return value;
}

/* ---- reference reflection ---- */

/* Cosines of lamp and viewer relative to the microfacets' normal. */
typedef struct Facing {
    double nl, nv, nh, vh;
    double c, s; /* cosine and sine of the angle between n and h */
} Facing;

static double dot(WrVec3 a, WrVec3 b)
{
    return v3_dot(a, b);
}

static WrVec3 unit_of(WrVec3 a)
{
    return v3_scale(a, 1 / sqrt(dot(a, a)));
}

/* Rule for normals that bump turned away from the viewer.
   n* = unit(n + (1e-3 - n.v) v) where n.v < 1e-3 (HC105): continuous across the silhouette, never black, never
   a flip. */
static WrVec3 bent_back(WrVec3 n, WrVec3 v)
{
    const double short_of = 1e-3 - dot(n, v);
    return short_of > 0 ? unit_of(v3_mad(n, v, short_of)) : n;
}

/* False where microfacets reflect nothing.
   c and s are normalised to c^2 + s^2 = 1, s from the cross product: 1 - c^2 has no digits left near a sharp
   peak (HC99). h is undefined for l = -v: nothing is reflected (HC97). */
static bool face(WrVec3 n, WrVec3 l, WrVec3 v, Facing *out)
{
    const WrVec3 seen = bent_back(n, v), sum = v3_add(l, v);
    if (!(dot(sum, sum) > 1e-12) || !(dot(n, l) > 0) || !(dot(seen, l) > 0)) return false;
    const WrVec3 h = unit_of(sum), across = v3_cross(seen, h);
    *out = (Facing){ .nl = dot(seen, l), .nv = dot(seen, v), .nh = dot(seen, h), .vh = dot(v, h) };
    const double side = sqrt(dot(across, across)), whole = sqrt(side * side + out->nh * out->nh);
    out->c = out->nh / whole, out->s = side / whole;
    return true;
}

/* Blinn 1977 with Cook's form of Fresnel's equation: g^2 = ior^2 + c^2 - 1.
   eta < 1 and gg < 0 is total reflection. For eta = 1 the result is 0 at every angle; the formula would be 0 /
   0 at c = 0 (HC102). */
static double fresnel(double c, double ior)
{
    const double gg = ior * ior + c * c - 1;
    if (gg < 0) return 1;
    if (ior == 1) return 0;
    const double g = sqrt(gg), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return fmin(0.5 * a * a * (1 + b * b), 1);
}

/* Directions, unit, n facing the viewer; colour: C of the surface. */
typedef struct Incidence {
    WrVec3 n, l, v;
    const double *colour;
} Incidence;

/* Formulas of the models named in shade/reflection_models.h. On entry own is Lambert's and white 0. */

/* Phong's lobe (r.v)^s with r = 2 (n.l) n - l, gated by n.l > 0. Near 1 the cosine is 1 - |r - v|^2 / 2, whose
   power keeps its digits. Energy-conserving form: times (s + 2) / 2 n.l. */
static double power_lobe(const WrMatter *m, WrEnergy energy, WrVec3 n, WrVec3 l, WrVec3 v)
{
    const double nl = dot(n, l);
    if (!(nl > 0)) return 0;
    const WrVec3 r = v3_sub(v3_scale(n, 2 * nl), l), off = v3_sub(r, v);
    const double c = dot(r, v), s = m->shininess;
    const double strength = energy == WR_ENERGY_KEPT ? nl * (s + 2) / 2 : 1;
    if (s == 0) return m->ks * strength;
    if (!(c > 0)) return 0;
    return m->ks * strength * (c > 0.5 ? exp(s * log1p(-dot(off, off) / 2)) : pow(c, s));
}

/* D G F / (n.v) as in Blinn 1977, with D = (c3^2 / (cos^2 (c3^2 - 1) + 1))^2, here c3 for c3^2; 1 - cos^2 is
   written as sin^2, which keeps its digits near the peak.
   1 / (4 c3^2) is the energy form's factor: D then integrates as GGX does (NUMERICS-LIGHT a). */
static double cavities(const WrMatter *m, WrEnergy energy, WrVec3 n, WrVec3 l, WrVec3 v)
{
    Facing at;
    if (!face(n, l, v, &at)) return 0;
    const double c = at.c, s = at.s, c3 = m->alpha * m->alpha;
    const double root = c3 / (c * c * c3 + s * s), d = root * root;
    const double whole = energy == WR_ENERGY_KEPT ? 1 / (4 * c3) : 1;
    const double g = fmin(1, fmin(2 * at.nh * at.nv / at.vh, 2 * at.nh * at.nl / at.vh));
    return m->ks * whole * d * g * fresnel(at.vh, m->ior) / at.nv;
}

static void phong(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                  double *white)
{
    (void)own;
    *white = power_lobe(m, energy, at->n, at->l, at->v);
}

static void torrance_sparrow(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                             double *white)
{
    (void)own;
    *white = cavities(m, energy, at->n, at->l, at->v);
}

/* Share that microfacets reflect directly, and the rest, for multiple reflection.
   Fujii's model as improved by Portsmouth, Kutz and Hill (EON): the exact albedo of the single reflection,
   E(mu) = a (1 + sigma/pi G(mu)). Multiple reflection adds (1 - E(l)) (1 - E(v)) / (1 - mean E), so a white
   surface reflects all light (HC103). */
static double matt_albedo(const WrMatter *m, double mu)
{
    const double s = sqrt(fmax(0, 1 - mu * mu));
    const double g = s * (acos(mu) - s * mu) + 2.0 / 3 * (s * mu * (1 + s + s * s) / (1 + s) - s);
    return m->a * (1 + m->sigma / pi * g);
}

/* q > 0 divides by max(n.l, n.v), q <= 0 by 1: no trigonometric function, no tan at 90 degrees (HC107). */
static void oren_nayar(const WrMatter *m, WrEnergy energy, const Incidence *at, double own[3],
                       double *white)
{
    const WrVec3 n = at->n, l = at->l, v = at->v;
    const double nl = fmin(fmax(0, dot(n, l)), 1), nv = fmin(fmax(0, dot(n, v)), 1);
    const double q = dot(l, v) - nl * nv, most = fmax(nl, nv);
    *white = own[0] = own[1] = own[2] = 0;
    if (!(nl > 0)) return;
    if (energy == WR_ENERGY_PUBLISHED) {
        const double rough = m->a + m->b * fmax(0, q) / most;
        for (int c = 0; c < 3; c++) own[c] = m->kd * nl * rough;
        return;
    }
    const double once = m->a * (1 + m->sigma * q / (q > 0 ? most : 1));
    const double mean = m->a * (1 + (2.0 / 3 - 28 / (15 * pi)) * m->sigma);
    const double left = (1 - matt_albedo(m, nl)) * (1 - matt_albedo(m, nv));
    for (int c = 0; c < 3; c++) {
        const double rho = fmin(fmax(0, m->kd * at->colour[c]), 1);
        const double again =
            m->sigma > 1e-6 ? left / (1 - mean) * rho * mean / (1 - rho * (1 - mean)) : 0;
        own[c] = m->kd * nl * (once + again);
    }
}

/* A polynomial in sqrt(mu), fitted once per material: the albedo is very steep at mu = 0, less so in the root. */
static double kept_albedo(const WrMatter *m, double mu)
{
    const double x = sqrt(fmin(fmax(0, mu), 1));
    double sum = 0, power = 1;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++, power *= x) sum += m->albedo[i] * power;
    return fmin(sum, 1);
}

/* GGX's D with sin^2 for 1 - cos^2, times Smith's height-correlated masking, n.l and pi; Schlick's Fresnel term
   with v.h = |l + v| / 2. Metal (share m->metal) reflects in the surface's colour.
   The diffuse part of a dielectric is (1 - E(l)) (1 - E(v)) m->again, with `again` 1 / (1 - mean E): the sum
   never exceeds 1. The glTF form 1 - F is kept as the published variant; it exceeds 1 for white dielectrics
   (HC103). */
static void ggx(const WrMatter *m, WrEnergy energy, const Incidence *by, double own[3],
                double *white)
{
    const WrVec3 n = by->n, l = by->l, v = by->v;
    Facing at;
    const double lit = dot(n, l), nv = dot(bent_back(n, v), v), a2 = m->alpha * m->alpha;
    *own = *white = 0;
    if (!(lit > 0)) return;
    double f = m->f0, lobe = 0, p = 0;
    const WrVec3 sum = v3_add(l, v);
    const double off = fmax(0, 1 - 0.5 * sqrt(dot(sum, sum)));
    p = off * off * off * off * off;
    f += (1 - m->f0) * p;
    if (face(n, l, v, &at)) {
        const double c = at.c, s = at.s, root = c * c * a2 + s * s;
        const double d = a2 / (root * root);
        lobe = m->ks * d * at.nl * 0.5 /
               (at.nl * sqrt(at.nv * at.nv * (1 - a2) + a2) +
                at.nv * sqrt(at.nl * at.nl * (1 - a2) + a2));
    }
    const double matt = m->kd * (1 - m->metal);
    const double left = matt == 0 ? 0
                        : energy == WR_ENERGY_KEPT
                            ? (1 - kept_albedo(m, lit)) * (1 - kept_albedo(m, nv)) * m->again
                            : 1 - f;
    own[0] = own[1] = own[2] = matt * lit * left + m->metal * (1 - p) * lobe;
    *white = (1 - m->metal) * f * lobe + m->metal * p * lobe;
}

#define CASE_STAGES(ID, formula)                                                                   \
    case WR_REFLECT_##ID:                                                                          \
        break; /* wr_reference_lamp */
#define CASE_UNIFORM(ID, formula)                                                                  \
    case WR_REFLECT_##ID:                                                                          \
        formula(m, energy, &at, own, white);                                                       \
        break;
#define CASE_ROUGH CASE_UNIFORM
#define CASE_METAL CASE_UNIFORM
#define CASE(ID, formula, LOOPS, ...) CASE_##LOOPS(ID, formula)

/* All vectors unit; n faces the viewer. colour: C(u,v), the picture's times the material's. own: to be
   multiplied by the surface's colour, each channel; white: by the lamp's colour only. */
static void reference_reflect(const WrMatter *m, int model, WrEnergy energy, WrVec3 n, WrVec3 l,
                              WrVec3 v, const double colour[3], double own[3], double *white)
{
    const Incidence at = { n, l, v, colour };
    *white = 0;
    own[0] = own[1] = own[2] = m->kd * fmax(0, dot(n, l));
    switch ((WrReflect)model) {
        WR_REFLECTION_MODELS(CASE)
    case WR_REFLECT_COUNT: break;
    }
}

#define WAVE 12 /* cells per wave of a formula */

/* The exact normal that a mode approximates; a mode that differs deliberately is kept.
   `blinn` is rendered with the true normal: the difference is the approximation's error. `invariant` is
   another model (B15), not an approximation, and is its own truth. */
static WrBumpMode truth_of(WrBumpMode mode)
{
    switch (mode) {
    case WR_BUMP_INVARIANT: return WR_BUMP_INVARIANT;
    case WR_BUMP_NONE:
    case WR_BUMP_BLINN:
    case WR_BUMP_EXACT:
    case WR_BUMP_COUNT: break;
    }
    return WR_BUMP_EXACT;
}

static bool has_slopes(const WrScene *scene)
{
    return scene->height != 0 || (scene->normals.image && scene->normals.strength != 0);
}

/* Height range of a relief that casts shadows.
   Relief shadows exist for periodic tables on unstretched surfaces of one chart; elsewhere `relief`
   stays 0 and nothing is shadowed. */
static void note_shadow(WrReferenceStage *stage, const WrField *field)
{
    const WrScene *scene = stage->scene;
    int columns, rows;
    float low, high;
    wr_surface_cells(&scene->shape, &columns, &rows);
    if ((!scene->material.shadow && !scene->material.occlusion) ||
        wr_surfaces[scene->shape.kind]->held || columns * rows != 1)
        return;
    if (!stage->periodic_u || !stage->periodic_v) return;
    if (scene->sizes.x != 0 || scene->sizes.y != 0 || scene->sizes.z != 0) return;
    wr_field_range(field, &low, &high);
    stage->relief = fabs(scene->height) * ((double)high - (double)low);
    stage->shadow = scene->material.shadow && scene->bump != WR_BUMP_NONE ? stage->relief : 0;
    stage->texels[0] = fabs(scene->replicate_u) * wr_field_width(field);
    stage->texels[1] = fabs(scene->replicate_v) * wr_field_height(field);
}

#define ROUGHS 257

/* Material parameters at steps of roughness, between which matter_at interpolates: the integrals change little.
   Only the range of steps that can occur is filled: wr_scene_matter integrates albedos. */
static void note_roughness(WrReferenceStage *stage)
{
    const WrSolidTexture *grain = &stage->scene->grain;
    const bool pictured = stage->scene->facets[WR_FACET_ROUGHNESS].image;
    const bool driven =
        grain->kind != WR_SOLID_TEXTURE_OFF && grain->drives & WR_SOLID_TEXTURE_ROUGHENS;
    WrMaterial m = stage->scene->material;
    if (!wr_reflects[m.model].roughness || (!pictured && !driven)) return;
    stage->rough = wr_alloc(ROUGHS, sizeof *stage->rough);
    const double low = pictured ? 0 : fmin(grain->roughness[0], grain->roughness[1]);
    const double high = pictured ? 1 : fmax(grain->roughness[0], grain->roughness[1]);
    for (int i = (int)floor(low * (ROUGHS - 1)); i <= (int)ceil(high * (ROUGHS - 1)); i++) {
        m.roughness = (double)i / (ROUGHS - 1);
        wr_scene_matter(&m, &stage->rough[i]);
    }
}

/* Roughness or metalness from its picture, bilinear. */
static double facet_at(const WrReferenceStage *stage, WrFacetKind kind, double u, double v)
{
    const WrFacetMap *map = &stage->scene->facets[kind];
    const WrTexels at = wr_texture_bilinear_taps(stage->scene, map->image, &map->laid,
                                                 stage->periodic_u, stage->periodic_v, u, v);
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += at.weight[k] * (double)at.texel[k][0];
    return sum;
}

static double roughness_at(const WrReferenceStage *stage, WrVec3 object, double u, double v)
{
    const WrSolidTexture *grain = &stage->scene->grain;
    if (stage->scene->facets[WR_FACET_ROUGHNESS].image)
        return facet_at(stage, WR_FACET_ROUGHNESS, u, v);
    const double g = reference_grain(grain, &stage->grain, object, NULL);
    return (1 - g) * grain->roughness[0] + g * grain->roughness[1];
}

/* The material's parameters at a point: alpha is exact, albedos are interpolated between two steps. */
static WrMatter matter_at(const WrReferenceStage *stage, WrVec3 object, double u, double v)
{
    const bool metals = wr_reflects[stage->scene->material.model].metalness &&
                        stage->scene->facets[WR_FACET_METALNESS].image;
    WrMatter out = stage->matter;
    if (metals) out.metal = facet_at(stage, WR_FACET_METALNESS, u, v);
    if (!stage->rough) return out;
    const double roughness = roughness_at(stage, object, u, v);
    const double x = fmin(roughness * (ROUGHS - 1), ROUGHS - 1), t = x - floor(x);
    const WrMatter *low = &stage->rough[(int)floor(x)], *high = &stage->rough[(int)ceil(x)];
    const double metal = out.metal;
    out = *low;
    out.metal = metal;
    out.alpha = fmax(roughness * roughness, WR_ALPHA_MIN), out.sigma = roughness;
    out.a += t * (high->a - low->a), out.b += t * (high->b - low->b);
    out.scale += t * (high->scale - low->scale), out.mean += t * (high->mean - low->mean);
    out.again += t * (high->again - low->again);
    for (int i = 0; i < WR_ALBEDO_TERMS; i++)
        out.albedo[i] += t * (high->albedo[i] - low->albedo[i]);
    return out;
}

bool wr_reference_stage_init(WrReferenceStage *stage, const WrField *field, const WrScene *scene,
                             double turn_deg, int width, int height, bool table, WrPool *pool,
                             WrError *err)
{
    const bool formula = scene->analytic.kind != WR_ANALYTIC_OFF;
    *stage = (WrReferenceStage){ .scene = scene, .periodic_u = true, .periodic_v = true };
    if (!field && !formula) return wr_fail(err, "a picture of a table: no table is given");
    if (field) {
        stage->periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
        stage->periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    }
    wr_scene_matter(&scene->material, &stage->matter);
    wr_solid_texture_noise(&scene->grain, &stage->grain);
    note_roughness(stage);
    stage->bump = has_slopes(scene) ? truth_of(scene->bump) : WR_BUMP_NONE;
    if (wr_surfaces[scene->shape.kind]->held && stage->bump == WR_BUMP_EXACT)
        stage->bump = WR_BUMP_BLINN; /* triangles are flat: it is exact there */
    if (!wr_reference_view_init(&stage->view, scene, turn_deg, width, height, err)) return false;
    reference_surround_init(&stage->surround, scene, stage->view.rotation);
    if (!table || formula || scene->height == 0) return true;
    note_shadow(stage, field);
    return wr_reference_table_init(&stage->table, field, pool, err);
}

bool wr_reference_displaced(const WrScene *scene)
{
    return scene->displaced && scene->height != 0 && !wr_shape_unmoved(&scene->shape);
}

static void height_of(const void *ctx, double u, double v, double *f, double *fu, double *fv)
{
    wr_reference_height(ctx, u, v, f, fu, fv);
}

/* Number of cells with one bend of F each: texels, or a fixed number per wave or power.
   A spline bends once per texel; WAVE cells per wave keep the bend within a cell small. */
static void cells_of(const WrScene *scene, const WrField *field, double cells[2])
{
    double u = field ? wr_field_width(field) : 1, v = field ? wr_field_height(field) : 1;
    const WrAnalytic *formula = &scene->analytic;
    if (formula->kind != WR_ANALYTIC_OFF) u = v = WAVE;
    for (int k = 0; k < formula->count && formula->kind != WR_ANALYTIC_OFF; k++) {
        u = fmax(u, WAVE * fabs((double)formula->terms[k].i));
        v = fmax(v, WAVE * fabs((double)formula->terms[k].j));
    }
    cells[0] = fabs(scene->replicate_u) * u, cells[1] = fabs(scene->replicate_v) * v;
}

bool wr_reference_stage_raise(WrReferenceStage *stage, const WrField *field, WrPool *pool,
                              WrError *err)
{
    double cells[2];
    cells_of(stage->scene, field, cells);
    if (wr_reference_has_parallax(stage->scene)) wr_reference_parallax_init(stage, field, cells);
    if (!wr_reference_displaced(stage->scene)) return true;
    stage->bump = WR_BUMP_EXACT;
    if (stage->view.info->held) {
        stage->bump = WR_BUMP_BLINN; /* triangles are flat: it is exact there */
        stage->view.raised = true;
        return wr_reference_raised_mesh_init(&stage->raised, stage->scene, field, pool, err);
    }
    return wr_reference_raised_init(&stage->raised, &stage->scene->shape, height_of, stage, cells,
                                    pool, err);
}

void wr_reference_stage_fini(WrReferenceStage *stage)
{
    wr_reference_raised_fini(&stage->raised);
    wr_reference_view_fini(&stage->view);
    wr_free(stage->rough);
    wr_reference_table_fini(&stage->table);
    reference_surround_fini(&stage->surround);
}

void wr_reference_height(const WrReferenceStage *stage, double u, double v, double *f, double *fu,
                         double *fv)
{
    if (stage->scene->analytic.kind != WR_ANALYTIC_OFF)
        wr_scene_height(stage->scene, NULL, u, v, f, fu, fv);
    else wr_reference_table_at(&stage->table, stage->scene, u, v, f, fu, fv);
}

void wr_reference_height_at(const WrReferenceStage *stage, const WrReferenceHit *hit, double *f,
                            double *fu, double *fv)
{
    const WrTriangles *mesh = stage->scene->triangles;
    WrReliefTap taps[WR_RELIEF_TAPS];
    WrReliefSum sum = { 0 };
    if (!mesh || !mesh->weights) {
        wr_reference_height(stage, hit->u, hit->v, f, fu, fv);
        return;
    }
    const int count = wr_relief_taps(mesh, hit->triangle, hit->share[0], hit->share[1], taps);
    for (int k = 0; k < count; k++) {
        wr_reference_height(stage, taps[k].u, taps[k].v, f, fu, fv);
        wr_relief_add(&sum, &taps[k], *f, *fu, *fv);
    }
    *f = sum.f;
    wr_relief_slopes(mesh, hit->triangle, &sum, fu, fv);
}

void wr_reference_add_map(const WrReferenceStage *stage, const WrReferenceHit *hit,
                          const WrSurfacePoint *at, double *fu, double *fv)
{
    WrMapAxes axes;
    if (!stage->scene->normals.image) return;
    const bool found = stage->view.info->held
                           ? wr_reference_mesh_axes(&stage->view.mesh, hit, &axes)
                           : wr_texture_sample_axes(wr_scene_frame(stage->scene), at, &axes);
    wr_texture_sample_add_normals(stage->scene, stage->periodic_u, stage->periodic_v, at,
                                  found ? &axes : NULL, hit->u, hit->v, fu, fv);
}

/* True if |a|^2 neither overflows nor loses digits to underflow when multiplied by a similar value. */
static bool ordinary(double squared)
{
    return squared > 1e-60 && squared < 1e60;
}

/* N' = (Pu + F n_u) x (Pv + F n_v) + n x (Fu qv - Fv qu) (B6 without its zero term); blinn drops n_u and n_v,
   invariant scales D to length |grad F| in parameter units (B15). If the sum is below 1e-8 of its terms it
   consists of rounding errors, or squares leave double range: then shade/bump.h's scaled form decides (HC09 to
   HC15). */
WrVec3 wr_reference_normal(WrBumpMode mode, const WrSurfacePoint *at, double f, double fu,
                           double fv)
{
    if (mode == WR_BUMP_NONE || (fu == 0 && fv == 0 && f == 0)) return at->n_unit;
    const WrVec3 n = at->n_unit;
    WrVec3 qu = at->pu, qv = at->pv;
    if (mode == WR_BUMP_EXACT) qu = v3_mad(qu, at->n_u, f), qv = v3_mad(qv, at->n_v, f);
    const WrVec3 tip = v3_cross(n, v3_sub(v3_scale(qv, fu), v3_scale(qu, fv)));
    WrVec3 sum;
    double terms; /* the square of the summands: a sum that cancels is left to shade/bump.h */
    const double uu = v3_dot(qu, qu), vv = v3_dot(qv, qv);
    if (mode == WR_BUMP_INVARIANT) {
        const double d = sqrt(v3_dot(tip, tip)), a = sqrt(fu * fu + fv * fv);
        sum = v3_mad(n, tip, a / d);
        terms = ordinary(d * d) && ordinary(uu) && ordinary(vv) && a > 1e-30 && a < 1e30 ? 1 : 0;
    } else {
        const WrVec3 flat = mode == WR_BUMP_EXACT ? v3_cross(qu, qv) : at->n;
        sum = v3_add(flat, tip);
        terms = uu * vv + fu * fu * vv + fv * fv * uu;
        if (!(fabs(fu) < 1e30 && fabs(fv) < 1e30 && ordinary(uu) && ordinary(vv))) terms = 0;
    }
    const double squared = v3_dot(sum, sum);
    if (terms > 0 && squared > 1e-16 * terms) return v3_scale(sum, 1 / sqrt(squared));
    return wr_bump_unit_normal(mode, at->n, n, at->pu, at->pv, at->n_u, at->n_v, f, fu, fv);
}

double wr_reference_side(const WrReferenceView *view, const WrSurfacePoint *at)
{
    const WrVec3 to = view->perspective ? v3_sub(view->eye, at->p) : view->toward;
    return v3_dot(at->n_unit, to) < 0 ? -1 : 1;
}

/* a / |a|; 0 for the zero vector. */
static WrVec3 unit(WrVec3 a)
{
    const double squared = v3_dot(a, a);
    const WrVec3 zero = { 0, 0, 0 };
    return ordinary(squared) ? v3_scale(a, 1 / sqrt(squared)) : v3_unit(a, zero);
}

/* C(u,v) of the picture, bilinear. */
static void picture_colour(const WrReferenceStage *stage, double u, double v, double rgb[3])
{
    const WrScene *scene = stage->scene;
    const bool colours = scene->colour->channels >= 3;
    const WrTexels at = wr_texture_bilinear_taps(scene, scene->colour, &scene->colour_laid,
                                                 stage->periodic_u, stage->periodic_v, u, v);
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) rgb[c] += at.weight[k] * (double)at.texel[k][colours ? c : 0];
}

/* max(0, n'.h)^s of unit vectors; near 1 from 1 - n'.h = |n' - h|^2 / 2, so that a high power loses no digits.
   HC89, HC90: pow(1 - x, s) with x = |n' - h|^2 / 2 is exp(s log1p(-x)); no value above 1 can occur. */
static double lobe(WrVec3 perturbed, WrVec3 h, double s)
{
    const double nh = v3_dot(perturbed, h);
    const WrVec3 off = v3_sub(perturbed, h);
    if (!(s > 0)) return 1;
    if (nh > 0.5) return exp(s * log1p(-v3_dot(off, off) / 2));
    return nh > 0 ? pow(nh, s) : 0;
}

void wr_reference_lamp(const WrMaterial *m, const WrMatter *matter, WrVec3 n, WrVec3 l, WrVec3 v,
                       const double colour[3], double own[3], double *white)
{
    const WrVec3 h = v3_add(l, v);
    const double nl = v3_dot(n, l), hh = v3_dot(h, h);
    if (m->model != WR_REFLECT_DEFAULT) {
        reference_reflect(matter, m->model, m->energy, n, l, v, colour, own, white);
    } else {
        *white = 0;
        if (m->specular != 0 && (nl > 0 || !m->gate) && hh > 1e-24)
            *white = m->specular * lobe(n, v3_scale(h, 1 / sqrt(hh)), m->shininess);
        own[0] = own[1] = own[2] = m->diffuse * (nl > 0 ? nl : 0);
    }
    for (int c = 0; c < 3; c++) own[c] += m->tint * *white;
    *white *= 1 - m->tint;
}

/* C at a point of the surface without the material's colour. */
static void place_colour(const WrReferenceStage *stage, WrVec3 object, double u, double v,
                         double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 1;
    if (stage->scene->colour) picture_colour(stage, u, v, rgb);
    const WrSolidTexture *grain = &stage->scene->grain;
    if (grain->kind == WR_SOLID_TEXTURE_OFF || !(grain->drives & WR_SOLID_TEXTURE_COLOURS)) return;
    const double g = reference_grain(grain, &stage->grain, object, NULL);
    for (int c = 0; c < 3; c++) rgb[c] *= (1 - g) * grain->light[c] + g * grain->dark[c];
}

/* n' bent by the solid texture's heights: the surface displaced along n by them (Perlin 1985).
   n' = unit(n - (g - (g.n) n)), g = height * gradient: without the projection a slope along n would change the
   normal's length and so the tilt (NUMERICS-LIGHT c). Object space, so that the grain does not swim (HC120). */
static WrVec3 embossed(const WrReferenceStage *stage, WrVec3 object, double side, WrVec3 n)
{
    const WrSolidTexture *grain = &stage->scene->grain;
    WrVec3 slope;
    if (grain->kind == WR_SOLID_TEXTURE_OFF || !(grain->drives & WR_SOLID_TEXTURE_BUMPS)) return n;
    reference_grain(grain, &stage->grain, object, &slope);
    const WrVec3 s = v3_scale(slope, side * grain->height);
    return unit(v3_sub(n, v3_mad(s, n, -v3_dot(s, n))));
}

/* I = C (ka + kd terms) + white terms (DESIGN, "Shading"): `own` is multiplied by the surface's colour,
   `white` is not. Light is summed over lamps in their order, in double. */
void wr_reference_light(const WrReferenceStage *stage, const WrSurfacePoint *at,
                        const WrReferenceHit *hit, WrVec3 perturbed, WrReferenceShare share,
                        double rgb[3])
{
    const double u = hit->u, v = hit->v;
    const WrMaterial *m = &stage->scene->material;
    const WrReferenceView *view = &stage->view;
    const WrVec3 p = wr_reference_stretched(view, at->p);
    const WrVec3 to = view->perspective ? unit(v3_sub(view->lit_eye, p)) : view->lit_toward;
    const double open =
        stage->relief > 0 && m->occlusion ? reference_open(stage, at, u, v, perturbed) : 1;
    const double ambient = open * m->ambient;
    double diffuse[3] = { ambient, ambient, ambient }, shine[3] = { 0, 0, 0 };
    double colour[3];
    place_colour(stage, at->p, u, v, colour);
    const WrMatter matter = matter_at(stage, at->p, u, v);
    double has[3] = { m->colour.x * colour[0], m->colour.y * colour[1], m->colour.z * colour[2] };
    const bool kept = wr_reflect_shares(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    for (int c = 0; c < 3 && kept; c++) has[c] = fmin(fmax(has[c], 0), 1);
    for (int i = 0; i < view->light_count; i++) {
        const WrReferenceLight *light = &view->lights[i];
        const WrVec3 way = v3_sub(light->where, p), l = light->point ? unit(way) : light->where;
        const double away = light->point ? v3_len(way) : INFINITY;
        double own[3], white;
        double seen = stage->shadow > 0 ? reference_lamp_share(stage, at, u, v, perturbed, l, away,
                                                               light->radius, share)
                                        : 1;
        if (light->shadow && seen > 0)
            seen *= reference_cast_share(stage, at, hit, perturbed, l, away, light->radius, share);
        if (seen == 0) continue;
        wr_reference_lamp(m, &matter, perturbed, l, to, has, own, &white);
        for (int c = 0; c < 3; c++) {
            diffuse[c] += seen * light->rgb[c] * own[c];
            shine[c] += seen * light->rgb[c] * white;
        }
    }
    double around[3], mirrored[3];
    reference_surround_light(stage, &matter, perturbed, to, has, share, around, mirrored);
    for (int c = 0; c < 3; c++)
        rgb[c] = has[c] * (diffuse[c] + open * around[c]) + shine[c] + mirrored[c];
}

/* Squared motion of the hit in u and v, on the plane, for one pixel step: q + s d, with s changing so that it
   stays on the plane. */
static double step_squared(const WrReferenceRay *ray, const WrReferenceRay *step, double s,
                           const WrSurfacePoint *at, double ru, double rv)
{
    const WrVec3 free = v3_mad(step->q, step->d, s);
    const double ds = -v3_dot(free, at->n_unit) / v3_dot(ray->d, at->n_unit);
    const WrVec3 moved = v3_mad(free, ray->d, ds);
    const double du = ru * v3_dot(moved, at->pu) / v3_dot(at->pu, at->pu);
    const double dv = rv * v3_dot(moved, at->pv) / v3_dot(at->pv, at->pv);
    return du * du + dv * dv;
}

/* 1 up to a quarter of half a period, or of the plane, per pixel; 0 from a whole one on.
   An endless plane towards the horizon: beyond half a period per pixel slopes would be aliased noise. Smoothstep
   between. */
static double left_of(double squares)
{
    const double t = fmin(fmax((sqrt(squares) - 0.25) / 0.75, 0), 1);
    return 1 - t * t * (3 - 2 * t);
}

/* Remaining weight of slopes there, and of the plane (`cover`). */
static double eased_at(const WrReferenceStage *stage, const WrReferenceRay *ray,
                       const WrReferenceHit *hit, const WrSurfacePoint *at, double *cover)
{
    const WrScene *scene = stage->scene;
    const double ru = 2 * fmax(1, fabs(scene->replicate_u)); /* in half periods */
    const double rv = 2 * fmax(1, fabs(scene->replicate_v));
    double periods = 0, sides = 0;
    WrReferenceRay step[2];
    *cover = 1;
    if (!wr_shape_endless(stage->view.shape) || !stage->view.perspective) return 1;
    wr_reference_view_spread(&stage->view, &step[0], &step[1]);
    for (int k = 0; k < 2; k++) {
        periods += step_squared(ray, &step[k], hit->s, at, ru, rv);
        sides += step_squared(ray, &step[k], hit->s, at, 1, 1);
    }
    *cover = isfinite(sides) ? left_of(sides) : 0;
    return isfinite(periods) ? left_of(periods) : 0;
}

/* As in the picture: cosine below which a facet of relief does not decide the side. */
#define TILTED 0.3

static bool hit_stage(const WrReferenceStage *stage, const WrReferenceRay *ray, WrReferenceHit *hit,
                      WrSurfacePoint *at, double *side)
{
    if (stage->parallax) return wr_reference_parallax(stage, ray, hit, at, side);
    const bool met = stage->raised.count > 0 ? wr_reference_raised_hit(&stage->raised, ray, hit)
                                             : wr_reference_view_hit(&stage->view, ray, hit);
    if (!met) return false;
    wr_reference_surface_point(&stage->view, hit, at);
    *side = wr_reference_side(&stage->view, at);
    return true;
}

bool wr_reference_sample(const WrReferenceStage *stage, double x, double y, WrReferenceShare share,
                         WrReferenceSample *out)
{
    const WrReferenceView *view = &stage->view;
    const WrReferenceRay ray = wr_reference_view_ray(view, x, y);
    WrReferenceHit hit;
    WrSurfacePoint at;
    double f = 0, fu = 0, fv = 0, side;
    if (!hit_stage(stage, &ray, &hit, &at, &side)) return false;
    if (stage->scene->height != 0) wr_reference_height_at(stage, &hit, &f, &fu, &fv);
    wr_reference_add_map(stage, &hit, &at, &fu, &fv);
    const double eased = eased_at(stage, &ray, &hit, &at, &out->cover);
    fu *= eased, fv *= eased;
    const WrVec3 perturbed = wr_reference_normal(stage->bump, &at, f, fu, fv);
    WrVec3 seen = v3_scale(perturbed, side);
    if (stage->raised.count > 0) {
        at.p = v3_mad(ray.q, ray.d, hit.s); /* at an edge this is not P + F n */
        const WrVec3 facet = stage->raised.base ? v3_unit(hit.facet, perturbed) : perturbed;
        const double along = v3_dot(facet, perturbed);
        const double away = fabs(along) < TILTED * v3_len(perturbed) ? v3_dot(perturbed, ray.d)
                                                                     : v3_dot(facet, ray.d) * along;
        seen = away > 0 ? v3_neg(perturbed) : perturbed;
    }
    out->normal = embossed(stage, at.p, side, seen);
    out->lost = hit.lost;
    out->depth = view->size * v3_dot(v3_sub(at.p, view->eye), view->deep);
    out->normal = wr_reference_normal_stretched(view, out->normal);
    wr_reference_light(stage, &at, &hit, out->normal, share, out->rgb);
    for (int c = 0; c < 3; c++) out->rgb[c] *= out->cover;
    return true;
}
