#include "render/reference/reference_environment.h"

#include "base/memory.h"
#include "image/image.h"
#include "render/reference/reference_shade.h"
#include "scene/scene.h"

#include <math.h>

/* Parts of the sphere for the sum of diffuse light: so small that a cosine is nearly linear over each. */
#define ACROSS 96
#define DOWN 48
#define FACETS WR_REFERENCE_FACETS
#define FINE 4 /* sample points a side in each part of a small picture */

static const double pi = 3.14159265358979323846;

static int wrapped(int i, int count)
{
    return (i % count + count) % count;
}

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

/* n x m sample points of one part: its light, and its mean direction. */
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

static int places(int texels, int parts)
{
    const int n = (texels + parts - 1) / parts;
    return n < FINE ? FINE : n;
}

void wr_reference_surround_init(WrReferenceSurround *surround, const WrScene *scene,
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

void wr_reference_surround_fini(WrReferenceSurround *surround)
{
    wr_free(surround->sectors);
    *surround = (WrReferenceSurround){ 0 };
}

/* True if the part at that column and row of a grid belongs to the share. Neighbours belong to other shares. */
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

/* Highlights: facets h, weighted by their distribution; each mirrors the light from 2 (v.h) h - v. */
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

void wr_reference_surround_light(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n,
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
