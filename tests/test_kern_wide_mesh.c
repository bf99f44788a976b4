/* Vector kernels of Newton's method, normals and bent normals: samples are generated from surface points by the
   formula in double precision, and the kernels must find these points again; data resumed in a static view is
   bit-identical. */
#include "kern_wide_help.h"

#define MET_BOUND 8e-6 /* sample positions are rounded */
#define REACH (1.0f / 48)

typedef struct Bench {
    Sets sets;
    WrShape shape;
    WrShapef shapef;
    WrWideSheet sheet;
    WrRays rays;
    WrNewton how;
    WrVec3 corner, right, up, back, eye;
    double step, away;
    WrStrip *got, *was, *want;
    WrSurfacePoint at[WR_SPAN]; /* surface points of the samples */
} Bench;

/* In double, unlike those of kern_wide_help.h. */
static double drawn(TestRandom *random, double low, double high)
{
    return low + (high - low) * test_random(random);
}

static WrVec3 drawn_unit(TestRandom *random)
{
    const WrVec3 a = { drawn(random, -1, 1), drawn(random, -1, 1), drawn(random, -1, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

static void choose_surface(TestRandom *random, WrSurfaceKind kind, Bench *b)
{
    wr_shape_default(kind, &b->shape);
    if (kind == WR_SURFACE_torus) {
        b->shape.value[0] = drawn(random, 0.5, 0.8);
        b->shape.value[1] = drawn(random, 0.1, 0.4);
    } else
        for (int k = 0; k < 48; k++) b->shape.value[k] += drawn(random, -0.15, 0.15);
    wr_shape_scaled(&b->shape, 1, &b->shapef);
    assert_true(wr_wide_sheet(kind, &b->shapef, &b->sheet));
    const bool closed = kind == WR_SURFACE_torus;
    b->how =
        (WrNewton){ .reach_u = REACH, .reach_v = REACH, .closed_u = closed, .closed_v = closed };
    for (int k = 0; k < 81; k++) { /* as measured in mesh.c */
        WrSurfacePoint at;
        wr_surface_at(&b->shape, 0, k % 9 / 8.0, k / 9 / 8.0, &at);
        b->how.uu = fmaxf(b->how.uu, 1.3f * (float)v3_len(at.puu));
        b->how.uv = fmaxf(b->how.uv, 1.3f * (float)v3_len(at.puv));
        b->how.vv = fmaxf(b->how.vv, 1.3f * (float)v3_len(at.pvv));
    }
}

static void choose_view(TestRandom *random, Bench *b)
{
    b->back = drawn_unit(random);
    b->right = v3_unit(v3_cross(drawn_unit(random), b->back), (WrVec3){ 1, 0, 0 });
    b->up = v3_cross(b->back, b->right);
    b->away = drawn(random, 2.5, 8);
    b->eye = v3_scale(b->back, b->away);
    b->step = drawn(random, 0.002, 0.02);
    b->corner = v3_mad(v3_scale(b->right, -1.5), b->up, 1.5);
    b->rays = (WrRays){ .perspective = test_random(random) < 0.6 };
    put3(b->rays.eye, b->eye), put3(b->rays.toward, b->back), put3(b->rays.q0, b->corner);
    put3(b->rays.qx, v3_scale(b->right, b->step)), put3(b->rays.qy, v3_scale(b->up, -b->step));
    put3(b->rays.d0, v3_scale(b->back, -1));
    if (!b->rays.perspective) return;
    put3(b->rays.d0, v3_scale(v3_sub(b->corner, b->eye), 1 / b->away));
    put3(b->rays.dx, v3_scale(b->right, b->step / b->away));
    put3(b->rays.dy, v3_scale(b->up, -b->step / b->away));
}

/* True if the surface there is not seen at a grazing angle. */
static bool is_open(const Bench *b, const WrSurfacePoint *at)
{
    const WrVec3 v = b->rays.perspective ? v3_sub(b->eye, at->p) : b->back;
    return at->n_len > 0.3 && fabs(v3_dot(at->n_unit, v)) > 0.35 * v3_len(v);
}

/* Samples at surface points, and initial guesses up to `off` of a cell away. */
static void choose_samples(TestRandom *random, double off, Bench *b)
{
    WrStrip *s = b->got;
    s->count = 1 + (int)(WR_SPAN * test_random(random));
    for (int i = 0; i < s->count; i++) {
        double u = 0, v = 0, t = 1;
        for (int k = 0; k < 300; k++) {
            u = drawn(random, 0.03, 0.97), v = drawn(random, 0.03, 0.97);
            wr_surface_at(&b->shape, 0, u, v, &b->at[i]);
            if (is_open(b, &b->at[i])) break;
        }
        if (!is_open(b, &b->at[i])) s->count = i; /* all of it faces away */
        const WrVec3 p = b->at[i].p;
        if (b->rays.perspective) t = b->away / (b->away - v3_dot(p, b->back));
        s->x[i] = (float)((v3_dot(p, b->right) * t + 1.5) / b->step);
        s->y[i] = (float)((1.5 - v3_dot(p, b->up) * t) / b->step);
        s->u[i] = (float)(u + off * (double)REACH * drawn(random, -1, 1));
        s->v[i] = (float)(v + off * (double)REACH * drawn(random, -1, 1));
    }
}

static void expect_near(const Bench *b, const char *what, double got, double want, double bound)
{
    if (!(fabs(got - want) <= bound * fmax(1, fabs(want))))
        fail_msg("%s, %s: %s is %.9g, not %.9g", b->sets.name, wr_surfaces[b->shape.kind]->name,
                 what, got, want);
}

static void expect_vec(const Bench *b, const char *what, const float *x, const float *y,
                       const float *z, int i, WrVec3 want, double bound)
{
    expect_near(b, what, (double)x[i], want.x, bound);
    expect_near(b, what, (double)y[i], want.y, bound);
    expect_near(b, what, (double)z[i], want.z, bound);
}

static void expect_places(const Bench *b)
{
    const WrStrip *s = b->got;
    for (int i = 0; i < s->count; i++) {
        const WrSurfacePoint *at = &b->at[i];
        expect_vec(b, "P", s->px, s->py, s->pz, i, at->p, MET_BOUND);
        expect_vec(b, "Pu", s->pux, s->puy, s->puz, i, at->pu, FAST_BOUND);
        expect_vec(b, "Pv", s->pvx, s->pvy, s->pvz, i, at->pv, FAST_BOUND);
        expect_vec(b, "n", s->nx, s->ny, s->nz, i, at->n_unit, FAST_BOUND);
        expect_near(b, "|N|", (double)s->n_len[i], at->n_len, 2 * FAST_BOUND);
    }
}

static void expect_bits(const Bench *b)
{
    const WrStrip *x = b->got, *y = b->was;
    const float *const is[] = { x->u,   x->v,   x->px,  x->py,  x->pz, x->pux,
                                x->puy, x->puz, x->pvx, x->pvy, x->pvz };
    const float *const was[] = { y->u,   y->v,   y->px,  y->py,  y->pz, y->pux,
                                 y->puy, y->puz, y->pvx, y->pvy, y->pvz };
    for (int i = 0; i < x->count; i++)
        for (int k = 0; k < 11; k++)
            if (wr_float_bits(is[k][i]) != wr_float_bits(was[k][i]))
                fail_msg("%s: number %d of sample %d is resumed otherwise", b->sets.name, k, i);
}

/* Good guesses need one evaluation and a final step; coarse ones several. Returns the number of final steps. */
static int solve(Bench *b, double off)
{
    int landed = 0;
    b->sets.wide->newton(&b->sheet, &b->rays, &b->how, false, b->got);
    assert_true(b->sets.wide->cross(b->sheet.noise, b->got));
    if (off < 1) expect_places(b);
    *b->was = *b->got;
    for (int i = 0; i < b->got->count; i++) {
        landed += b->got->wx[i] > 0;
        b->got->u[i] = b->got->rx[i], b->got->v[i] = b->got->ry[i];
    }
    b->sets.wide->newton(&b->sheet, &b->rays, &b->how, true, b->got);
    expect_bits(b);
    return landed;
}

static void places_come_out_again(void **state)
{
    (void)state;
    static const double offs[] = { 0.002, 0.6, 0.9, 3 };
    Bench b = { .got = wr_alloc(1, sizeof *b.got), .was = wr_alloc(1, sizeof *b.was) };
    for (int i = 0; set_of(i, &b.sets); i++) {
        TestRandom random = { 31 };
        int samples[2] = { 0, 0 }, landed[2] = { 0, 0 };
        for (int round = 0; b.sets.wide && round < 96; round++) {
            const double off = offs[round % 4];
            choose_surface(&random, round & 4 ? WR_SURFACE_torus : WR_SURFACE_bezier, &b);
            choose_view(&random, &b);
            b.how.steps = round & 8 ? 4 : 3;
            b.how.last = round & 8 ? 0.0f : 0x1p-15f;
            if (round & 16) b.how.enough_u = b.how.enough_v = 1e-5f;
            choose_samples(&random, off, &b);
            if (b.got->count == 0) continue;
            const int done = solve(&b, off);
            if (round & 8) assert_int_equal(done, 0);
            else samples[off > 0.1] += b.got->count, landed[off > 0.1] += done;
        }
        if (b.sets.wide) assert_true(landed[0] > 0.9 * samples[0] && landed[1] > 0.5 * samples[1]);
        if (b.sets.wide) assert_in_range(samples[0] + samples[1], 3000, 1000000);
    }
    wr_free(b.got);
    wr_free(b.was);
}

/* Frames of any kind, some nearly degenerate; level points, steep ones, and some too steep for these kernels. */
static void give_frames(TestRandom *random, int round, WrStrip *s)
{
    s->count = 1 + (int)(WR_SPAN * test_random(random));
    for (int i = 0; i < s->count; i++) {
        const double size = exp2(drawn(random, -3, 3)), thin = i % 9 == 4 ? 1e-4 : 1;
        const WrVec3 pu = v3_scale(drawn_unit(random), size), way = drawn_unit(random);
        const WrVec3 pv = v3_mad(v3_scale(way, thin * size), pu, drawn(random, -1, 1));
        const WrVec3 p = v3_scale(drawn_unit(random), 0.9), n = v3_cross(pu, pv);
        const WrVec3 unit = v3_unit(n, way);
        s->px[i] = (float)p.x, s->py[i] = (float)p.y, s->pz[i] = (float)p.z;
        s->pux[i] = (float)pu.x, s->puy[i] = (float)pu.y, s->puz[i] = (float)pu.z;
        s->pvx[i] = (float)pv.x, s->pvy[i] = (float)pv.y, s->pvz[i] = (float)pv.z;
        s->nx[i] = (float)unit.x, s->ny[i] = (float)unit.y, s->nz[i] = (float)unit.z;
        s->n_len[i] = (float)v3_len(n);
        const double steep = i % 7 == 3 ? 0 : i % 11 == 5 ? 1e5 : round % 8 == 7 ? 1e9 : 1;
        s->fu[i] = (float)(steep * drawn(random, -2, 2));
        s->fv[i] = (float)(steep * drawn(random, -2, 2));
    }
}

static void bent_normals_are_those_of_the_stage(void **state)
{
    (void)state;
    Bench b = { .got = wr_alloc(1, sizeof *b.got), .want = wr_alloc(1, sizeof *b.want) };
    for (int i = 0; set_of(i, &b.sets); i++) {
        TestRandom random = { 8 };
        int done = 0, steep = 0;
        for (int round = 0; b.sets.wide && round < 80; round++) {
            choose_view(&random, &b);
            give_frames(&random, round, b.got);
            *b.want = *b.got;
            b.sets.ref->bump[WR_BUMP_BLINN](&b.rays, b.want);
            if (!b.sets.wide->blinn(&b.rays, b.got)) {
                steep++;
                assert_true(round % 8 == 7);
                continue;
            }
            for (int k = 0; k < b.got->count; k++, done++)
                expect_vec(&b, "n'", b.got->bx, b.got->by, b.got->bz, k,
                           (WrVec3){ b.want->bx[k], b.want->by[k], b.want->bz[k] }, FAST_BOUND);
        }
        if (b.sets.wide) assert_true(done > 5000 && steep >= 9);
    }
    wr_free(b.got);
    wr_free(b.want);
}

/* Parallel Pu and Pv are reported, in any lane, but not beyond the strip. */
static void thin_places_are_told(void **state)
{
    (void)state;
    Bench b = { .got = wr_alloc(1, sizeof *b.got) };
    for (int i = 0; set_of(i, &b.sets); i++) {
        TestRandom random = { 8 };
        for (int round = 0; b.sets.wide && round < 40; round++) {
            give_frames(&random, 0, b.got);
            const int at = (int)(b.got->count * test_random(&random));
            b.got->pux[b.got->count % WR_SPAN] = NAN;
            if (b.got->count == WR_SPAN) continue;
            assert_true(b.sets.wide->cross(1e-7f, b.got));
            b.got->pvx[at] = b.got->pux[at], b.got->pvy[at] = b.got->puy[at];
            b.got->pvz[at] = b.got->puz[at] * (1 + 1e-7f);
            assert_false(b.sets.wide->cross(1e-4f, b.got));
        }
    }
    wr_free(b.got);
}

/* Spindle tori and threads have points where |N| is 0, or N is reversed. */
static void only_rings_are_for_vectors(void **state)
{
    (void)state;
    static const struct {
        double R, r;
        bool can;
    } rows[] = { { 1, 0.4, true }, { 1, 1, false }, { 0.3, 0.7, false },
                 { 0, 1, false },  { 1, 0, false }, { 1, 0.98, true } };
    WrWideSheet sheet;
    WrShapef shapef;
    WrShape shape;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        wr_shape_default(WR_SURFACE_torus, &shape);
        shape.value[0] = rows[k].R, shape.value[1] = rows[k].r;
        wr_shape_scaled(&shape, 1.7, &shapef);
        assert_int_equal(wr_wide_sheet(WR_SURFACE_torus, &shapef, &sheet), rows[k].can);
    }
    wr_shape_default(WR_SURFACE_ribbon, &shape);
    wr_shape_scaled(&shape, 1, &shapef);
    assert_false(wr_wide_sheet(WR_SURFACE_ribbon, &shapef, &sheet));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_come_out_again),
        cmocka_unit_test(bent_normals_are_those_of_the_stage),
        cmocka_unit_test(thin_places_are_told),
        cmocka_unit_test(only_rings_are_for_vectors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
