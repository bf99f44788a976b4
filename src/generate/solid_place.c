/* Positions of solids: lattices with random variation, and drawing. */
#include "generate/solid.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/pattern.h"

#define TRIANGLES_MAX 12000000 /* for all copies */

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++) sum += a[3 * row + k] * b[3 * k + column];
            out[3 * row + column] = sum;
        }
}

/* Reduces to [0, n) if the axis is periodic; by whole periods, so without rounding. */
static double wrapped(double x, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_CLAMP) return x;
    x -= n * floor(x / n);
    return x < n ? x : 0.0;
}

typedef struct Lattice {
    const WrParams *params;
    double x, y; /* of `at` */
    double step[2];
    int across, rows;
    double base[9], other[9]; /* rotation, and that of every other copy */
    uint32_t seed;
    WrWrap wrap_u, wrap_v;
    int width, height;
} Lattice;

/* -1..1 */
static double chance(const Lattice *l, int i, int j, int use)
{
    return 2.0 * wr_chance(l->seed, i, j, use) - 1.0;
}

static void turn_place(const Lattice *l, int i, int j, double out[9])
{
    const double *base = (i + j) % 2 ? l->other : l->base;
    double turn = wr_param_number(l->params, "turn"), tilt = wr_param_number(l->params, "tilt");
    double loose[9];
    const double angles[3] = { tilt * chance(l, i, j, 3), tilt * chance(l, i, j, 4),
                               turn * chance(l, i, j, 5) };
    if (turn > 0.0 || tilt > 0.0) {
        wr_z_turn(angles, loose);
        multiply(loose, base, out);
    } else {
        for (int k = 0; k < 9; k++) out[k] = base[k];
    }
}

/* (0, 0) is the first of the lowest row; the lattice's middle is at `at`. */
static WrSolidPlace place(const Lattice *l, int i, int j)
{
    double jitter = wr_param_number(l->params, "jitter"), dx = i - 0.5 * (l->across - 1);
    double dy = j - 0.5 * (l->rows - 1);
    if (j % 2) dx += wr_param_number(l->params, "stagger");
    WrSolidPlace p = { .scale = 1.0 + wr_param_number(l->params, "vary") * chance(l, i, j, 2) };
    double x = l->x + wr_z_place(dx * l->step[0] + jitter * chance(l, i, j, 0));
    double y = l->y - wr_z_place(dy * l->step[1] + jitter * chance(l, i, j, 1));
    p.at[0] = wrapped(x, l->width, l->wrap_u);
    p.at[1] = wrapped(y, l->height, l->wrap_v);
    p.at[2] = -wr_param_number(l->params, "sink") * p.scale;
    turn_place(l, i, j, p.turn);
    return p;
}

bool wr_solid_places(const WrParams *params, const WrGenerateJob *job, WrSolidPlace **places,
                     int64_t *count, WrError *err)
{
    const double *at = wr_param_value(params, "at")->number;
    const double *spacing = wr_param_value(params, "spacing")->number;
    Lattice l = { .params = params,
                  .across = wr_param_whole(params, "across"),
                  .rows = wr_param_whole(params, "rows"),
                  .seed = wr_param_seed(params),
                  .wrap_u = wr_field_wrap_u(job->like),
                  .wrap_v = wr_field_wrap_v(job->like),
                  .width = wr_field_width(job->like),
                  .height = wr_field_height(job->like) };
    l.x = wr_z_place(at[0] * l.width - 0.5);
    l.y = wr_z_place((1.0 - at[1]) * l.height - 0.5);
    l.step[0] = spacing[0] > 0.0 ? spacing[0] : (double)l.width / l.across;
    l.step[1] = spacing[1] > 0.0 ? spacing[1] : (double)l.height / l.rows;
    const double about_x[3] = { wr_param_number(params, "alternate"), 0.0, 0.0 };
    double alternate[9];
    wr_z_turn(wr_param_value(params, "rotate")->number, l.base);
    wr_z_turn(about_x, alternate);
    multiply(l.base, alternate, l.other);
    *count = (int64_t)l.across * l.rows;
    WrSolidPlace *made = wr_try_alloc((size_t)*count, sizeof *made, "places of solids", err);
    if (!made) return false;
    for (int j = 0; j < l.rows; j++)
        for (int i = 0; i < l.across; i++) made[(int64_t)j * l.across + i] = place(&l, i, j);
    *places = made;
    return true;
}

bool wr_solid_draw(const WrParams *params, WrZScene *scene, double rise, const WrGenerateJob *job,
                   WrRelief *out, WrError *err)
{
    scene->floor = 0.0;
    scene->soft = wr_param_number(params, "soft");
    scene->scale = wr_param_number(params, "height") / (rise > 0.0 ? rise : 1.0);
    return wr_zbuffer_draw(scene, job, out, err);
}

/* ---- nets ---- */

typedef struct Copies {
    const WrSolidNet *net;
    const WrSolidPlace *places;
    double (*turned)[3]; /* [point_count] of the present copy */
} Copies;

/* For loops over a net: false after a cancellation, which is checked at intervals. The result is then incomplete. */
static bool goes_on(int64_t i)
{
    return i % 4096 != 0 || !wr_progress_stopped();
}

/* Rotates the points about the origin, y down; returns the lowest and the highest z. */
static void turn_points(const Copies *c, const WrSolidPlace *p, double range[2])
{
    for (int64_t i = 0; i < c->net->point_count && goes_on(i); i++) {
        const double *q = c->net->points[i];
        for (int k = 0; k < 3; k++) {
            const double *m = &p->turn[3 * k];
            double x = p->scale * (m[0] * q[0] + m[1] * q[1] + m[2] * q[2]);
            c->turned[i][k] = k == 2 ? x : wr_z_place(k == 1 ? -x : x);
        }
        double z = c->turned[i][2];
        range[0] = i == 0 || z < range[0] ? z : range[0];
        range[1] = i == 0 || z > range[1] ? z : range[1];
    }
}

static void put_copy(const Copies *c, const WrSolidPlace *p, double low, WrZTriangle *out)
{
    for (int64_t i = 0; i < c->net->count && goes_on(i); i++)
        for (int k = 0; k < 3; k++) {
            const double *q = c->turned[c->net->corners[i][k]];
            out[i].x[k] = p->at[0] + q[0];
            out[i].y[k] = p->at[1] + q[1];
            out[i].z[k] = p->at[2] + (q[2] - low);
        }
}

bool wr_solid_draw_net(const WrParams *params, const WrSolidNet *net, const WrGenerateJob *job,
                       WrRelief *out, WrError *err)
{
    WrSolidPlace *places = NULL;
    int64_t count;
    if (!wr_solid_places(params, job, &places, &count, err)) return false;
    bool good = count * net->count <= TRIANGLES_MAX;
    if (!good)
        wr_fail(err, "%lld copies of %lld triangles: must be at most %d triangles together",
                (long long)count, (long long)net->count, TRIANGLES_MAX);
    WrZTriangle *triangles = NULL;
    Copies c = { net, places, NULL };
    if (good)
        triangles =
            wr_try_alloc((size_t)(count * net->count) + 1, sizeof *triangles, "triangles", err);
    if (triangles)
        c.turned = wr_try_alloc((size_t)net->point_count + 1, sizeof *c.turned, "points", err);
    good = triangles && c.turned;
    double rise = 0.0;
    for (int64_t i = 0; good && i < count; i++) {
        double range[2] = { 0.0, 0.0 };
        turn_points(&c, &places[i], range);
        put_copy(&c, &places[i], range[0], triangles + i * net->count);
        if (i == 0) rise = (range[1] - range[0]) / places[0].scale;
        good = !wr_progress_stopped() || wr_fail(err, "cancelled");
    }
    WrZScene scene = { .triangles = triangles, .triangle_count = count * net->count };
    good = good && wr_solid_draw(params, &scene, rise, job, out, err);
    wr_free(c.turned);
    wr_free(triangles);
    wr_free(places);
    return good;
}
