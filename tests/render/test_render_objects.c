/* Several objects in one picture: each sample belongs to the nearest object, bit-identical to a picture of it
   alone. */
#include "test.h"
#include "render_sets.h"

#include "render/kernels/kern.h"
#include "render/reference/reference.h"
#include "scene/objects.h"

/* Ry(turn) Rz Ry Rx of the pose, written out. */
static WrVec3 into_world(const WrScene *scene, double turn_deg, WrVec3 p)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const WrVec3 pose = scene->posed
                            ? scene->rotate_deg
                            : (WrVec3){ info->pose_deg[0], info->pose_deg[1], info->pose_deg[2] };
    const double k = WR_PI / 180, a = pose.x * k, b = pose.y * k, c = pose.z * k, t = turn_deg * k;
    WrVec3 q = v3_scale(v3_sub(p, wr_shape_centre(&scene->shape)), scene->size);
    q = (WrVec3){ q.x, q.y * cos(a) - q.z * sin(a), q.y * sin(a) + q.z * cos(a) };
    q = (WrVec3){ q.x * cos(b) + q.z * sin(b), q.y, q.z * cos(b) - q.x * sin(b) };
    q = (WrVec3){ q.x * cos(c) - q.y * sin(c), q.x * sin(c) + q.y * cos(c), q.z };
    q = v3_add(q, scene->at);
    return (WrVec3){ q.x * cos(t) + q.z * sin(t), q.y, q.z * cos(t) - q.x * sin(t) };
}

/* How far before the eye's plane the object lies at a pixel's centre, by the reference; infinite: it is not there. */
static double depth_at(const Set *set, int i, int x, int y)
{
    WrError err;
    WrProbe probe;
    const WrCamera *camera = &set->alone[i]->camera;
    assert_true(
        wr_reference_probe(set->field[i], set->alone[i], W, H, 15, x + 0.5, y + 0.5, &probe, &err));
    if (!probe.hit) return INFINITY;
    const WrVec3 world = into_world(set->alone[i], 15, probe.at.p);
    const WrVec3 ahead = v3_unit(v3_sub(camera->target, camera->eye), (WrVec3){ 0, 0, 0 });
    return v3_dot(v3_sub(world, camera->eye), ahead);
}

static void each_sample_is_the_nearest_objects(void **state)
{
    (void)state;
    TestRandom random = { 4071 };
    int sure = 0, unsure = 0, several = 0, off = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 60 : 8); k++) {
        Set set = some_set(&random, 2 + k % (MAX_MOST - 1));
        const WrFrameRequest request = request_of(&set);
        Shot all = shoot_set(&request, 2, "auto");
        Shot own[MAX_MOST];
        for (int i = 0; i < set.count; i++)
            own[i] = shoot(set.alone[i], set.field[i], W, H, 1, "auto", false);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const size_t at = 4 * (size_t)(y * W + x);
                double nearest = INFINITY, next = INFINITY;
                int which = -1, covering = 0;
                bool edge = false;
                for (int i = 0; i < set.count; i++) covering += own[i].frame.rgba[at + 3] > 0;
                several += covering > 1;
                if (covering > 1 && (x + 2 * y) % 5 != k % 5) continue; /* probes take long */
                for (int i = 0; i < set.count; i++) {
                    if (own[i].frame.rgba[at + 3] == 0) continue;
                    const double depth = covering > 1 ? depth_at(&set, i, x, y) : 0;
                    edge |= depth == INFINITY; /* outside of the exact surface's outline */
                    if (depth < nearest) next = nearest, nearest = depth, which = i;
                    else next = fmin(next, depth);
                }
                const float nothing[4] = { 0 };
                if (covering > 0 && (edge || !(next - nearest > 1e-4))) {
                    unsure++;
                    continue;
                }
                sure++;
                const float *want = covering ? own[which].frame.rgba + at : nothing;
                off += memcmp(all.frame.rgba + at, want, sizeof nothing) != 0;
            }
        for (int i = 0; i < set.count; i++) put_away(&own[i]);
        put_away(&all);
        put_set_away(&set);
    }
    assert_in_range(unsure, 0, sure / 200);
    assert_in_range(
        off, 0,
        sure / 5000); /* along outlines a mesh may show another sheet than the exact surface */
    assert_in_range(several, sure / 10, sure);
}

static void nothing_depends_on_threads_kernels_or_the_plan(void **state)
{
    (void)state;
    static const char *const isas[] = { "ref", "v1", "v2", "v3", "v4" };
    TestRandom random = { 22 };
    for (int k = 0; k < 10; k++) {
        Set set = some_set(&random, 2 + k % (MAX_MOST - 1));
        WrDials dials = set.together->dials;
        dials.aa = k % 2 ? WR_AA_SUPERSAMPLE : k % 4 ? WR_AA_ADAPTIVE : WR_AA_FILTER;
        dials.samples = 2 + k % 3;
        WrFrameRequest request = request_of(&set);
        request.dials = &dials;
        Shot first = shoot_set(&request, 1, "ref");
        for (int i = 0; i < 5; i++) {
            if (!wr_kernels_get(isas[i], false, NULL)) continue;
            Shot other = shoot_set(&request, i == 4 ? 7 : i, isas[i]);
            if (!same_picture(&first, &other)) fail_msg("set %d on %s", k, isas[i]);
            put_away(&other);
        }
        request.full = true;
        Shot full = shoot_set(&request, 2, "auto");
        if (worst_difference(&first, &full) > 2e-6f)
            fail_msg("set %d: --full is off by %g", k, (double)worst_difference(&first, &full));
        put_away(&full);
        put_away(&first);
        put_set_away(&set);
    }
}

/* K x K samples against a picture of as many pixels, sample by sample. */
static void samples_are_those_of_a_larger_picture(void **state)
{
    (void)state;
    TestRandom random = { 31 };
    for (int k = 0; k < 6; k++) {
        Set set = some_set(&random, 3);
        const int n = 2 + k % 3;
        WrDials dials = set.together->dials;
        WrFrameRequest request = request_of(&set);
        request.width *= n, request.height *= n;
        Shot large = shoot_set(&request, 2, "auto");
        dials.aa = WR_AA_SUPERSAMPLE, dials.samples = n;
        request = request_of(&set);
        request.dials = &dials;
        Shot small = shoot_set(&request, 1, "auto");
        int off = 0;
        for (int p = 0; p < W * H * 4; p++) {
            double mean = 0;
            for (int s = 0; s < n * n; s++) {
                const int x = p / 4 % W * n + s % n, y = p / 4 / W * n + s / n;
                mean += (double)large.frame.rgba[4 * (y * W * n + x) + p % 4] / (n * n);
            }
            off += fabs(mean - (double)small.frame.rgba[p]) > 1e-4;
        }
        assert_in_range(
            off, 0,
            W * H * 4 /
                100); /* rays that pass an edge differ in their last place, meshes in their cells */
        put_away(&small);
        put_away(&large);
        put_set_away(&set);
    }
}

/* Bands, blocks and codes are equal to the whole picture. */
static void parts_of_the_picture_are_the_wholes(void **state)
{
    (void)state;
    TestRandom random = { 47 };
    WrError err = { "" };
    static const WrAntialias kinds[] = { WR_AA_POINT, WR_AA_SUPERSAMPLE, WR_AA_ADAPTIVE };
    for (int k = 0; k < 9; k++) {
        Set set = some_set(&random, 2 + k % 4);
        WrDials dials = set.together->dials;
        dials.aa = kinds[k % 3], dials.samples = 3 + k % 2;
        WrFrameRequest request = request_of(&set);
        request.dials = &dials;
        Shot whole = shoot_set(&request, 1, "auto");
        WrFrame frame;
        WrPool *pool = wr_pool_new(2);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        request.first = 7, request.rows = 29;
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        assert_memory_equal(frame.rgba, whole.frame.rgba + 4 * 7 * W, 29 * W * 4 * sizeof(float));
        request.first = request.rows = 0;
        request.codes = (WrFrameCodes){ true, .background.top = { 0.1, 0.4, 0.02 } };
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        uint8_t bgra[W * H * 4];
        wr_frame_to_srgb8(&whole.frame, &request.codes, true, bgra, pool);
        assert_memory_equal(frame.codes, bgra, sizeof bgra);
        request.codes.wanted = false;
        unsigned char only[((W + 7) / 8) * ((H + 7) / 8)];
        for (size_t i = 0; i < sizeof only; i++) only[i] = test_random(&random) < 0.4;
        request.only = only;
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                if (only[y / 8 * ((W + 7) / 8) + x / 8])
                    assert_memory_equal(frame.rgba + 4 * (y * W + x),
                                        whole.frame.rgba + 4 * (y * W + x), 4 * sizeof(float));
        wr_renderer_free(renderer);
        wr_pool_free(pool);
        put_away(&whole);
        put_set_away(&set);
    }
}

/* Edits of any object's table in a static view: every pixel equals a new picture, and unaffected tiles are not
   rendered. */
static void edits_of_a_resting_view(void **state)
{
    (void)state;
    TestRandom random = { 909 };
    WrError err = { "" };
    int64_t drawn = 0, all = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 12 : 3); k++) {
        Set set = some_set(&random, 2 + k % 4);
        set.together->dials.aa =
            k % 3 ? k % 3 > 1 ? WR_AA_ADAPTIVE : WR_AA_SUPERSAMPLE : WR_AA_POINT;
        set.together->dials.samples = 2;
        WrPool *pool = wr_pool_new(1 + k % 3);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        for (int edit = 0; edit < 40; edit++) {
            WrFrame frame;
            WrFrameRequest request = request_of(&set);
            request.keep = true;
            assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
            request.keep = false;
            Shot fresh = shoot_set(&request, 1, "auto");
            if (memcmp(frame.rgba, fresh.frame.rgba, frame_bytes(&frame)) != 0)
                fail_msg("set %d after edit %d", k, edit);
            drawn += edit ? frame.shaded : 0, all += edit ? fresh.frame.shaded : 0;
            put_away(&fresh);
            const int own = (int)(set.count * test_random(&random));
            WrField *next = wr_field_share(set.field[own]);
            const int i = (int)(wr_field_width(next) * test_random(&random));
            const int j = edit % 5 ? (int)(wr_field_height(next) * test_random(&random)) : 0;
            wr_field_set(next, i, j, (float)between(&random, -3, 3));
            wr_field_free(set.field[own]);
            set.fields[own] = set.field[own] = next;
        }
        wr_renderer_free(renderer);
        wr_pool_free(pool);
        put_set_away(&set);
    }
    assert_in_range(drawn, 1, all * 9 / 10);
}

/* Against the reference, which traces every sample separately, within the errors of single precision and the
   scheme. */
static void the_reference_sees_the_same(void **state)
{
    (void)state;
    TestRandom random = { 64 };
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    for (int k = 0; k < 3; k++) {
        Set set = some_set(&random, 3);
        WrReference reference = { 0 };
        const WrReferenceRequest wanted = { .field = set.field[0],
                                            .fields = set.fields,
                                            .scene = set.together,
                                            .width = W,
                                            .height = H,
                                            .turn_deg = 15,
                                            .first = 4,
                                            .most = 4 };
        for (int i = 0; i < set.count; i++) set.alone[i]->height = 0; /* no slopes: no scheme */
        set.together->height = 0;
        WrDials dials = set.together->dials;
        dials.aa = WR_AA_SUPERSAMPLE, dials.samples = 4;
        WrFrameRequest request = request_of(&set);
        request.dials = &dials;
        Shot shot = shoot_set(&request, 2, "auto");
        assert_true(wr_reference_render(&wanted, pool, &reference, &err));
        int off = 0;
        double sum = 0;
        for (int i = 0; i < W * H * 4; i++) {
            const double d = fabs(reference.rgba[i] - (double)shot.frame.rgba[i]);
            off += d > 1e-3;
            sum += d;
        }
        assert_in_range(off, 0, W * H * 4 / 50); /* outlines: a mesh and single precision */
        assert_true(sum < 1e-3 * W * H * 4);
        wr_reference_fini(&reference);
        put_away(&shot);
        put_set_away(&set);
    }
    wr_pool_free(pool);
}

static void a_pointer_finds_what_is_seen(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    int found = 0;
    for (int k = 0; k < 12; k++) {
        Set set = some_set(&random, 2 + k % 4);
        const WrFrameRequest request = request_of(&set);
        Shot all = shoot_set(&request, 1, "auto");
        for (int n = 0; n < 60; n++) {
            const int x = (int)between(&random, 0, W), y = (int)between(&random, 0, H);
            int object = -1, face, nearest = -1;
            double u, v, depth = INFINITY, next = INFINITY;
            const bool hit =
                wr_renderer_pick_object(all.renderer, x + 0.5, y + 0.5, &object, &u, &v, &face);
            for (int i = 0; i < set.count; i++) {
                const double own = depth_at(&set, i, x, y);
                if (own < depth) next = depth, depth = own, nearest = i;
                else next = fmin(next, own);
            }
            assert_int_equal(hit, all.frame.rgba[4 * (y * W + x) + 3] > 0);
            if (!hit || nearest < 0 || next - depth < 1e-4) continue;
            found++;
            assert_int_equal(object, nearest);
        }
        put_away(&all);
        put_set_away(&set);
    }
    assert_in_range(found, 100, 720);
}

/* Objects behind one that fills a tile are not rendered (E52), and no depth is computed where there is one object
   (E53). */
static void the_hidden_costs_nothing(void **state)
{
    (void)state;
    WrScene *front = scene_of("plane"), *back = scene_of("sphere");
    WrField *field = random_field(64, 48, 3);
    front->size = 9;
    back->at = (WrVec3){ 0, 0, -3 };
    front->camera.orthographic = true, front->camera.size = 2;
    Shot plane = shoot(front, field, W, H, 1, "auto", false);
    front->others = wr_alloc(1, sizeof *front->others);
    front->others[front->other_count++] = back;
    front->chosen = 1; /* the hidden one is the first of the scene's */
    Shot both = shoot(front, field, W, H, 1, "auto", false);
    assert_true(same_picture(&plane, &both));
    assert_int_equal(both.frame.shaded, W * H);
    Shot full = shoot(front, field, W, H, 1, "auto", true);
    assert_true(same_picture(&plane, &full));
    back->hidden = true;
    Shot one = shoot(front, field, W, H, 1, "auto", false);
    assert_true(same_picture(&plane, &one));
    assert_false(one.frame.plan->rows[WR_EFFECT_BETWEEN].ran);
    assert_true(both.frame.plan->rows[WR_EFFECT_BETWEEN].ran);
    front->hidden = true;
    Shot none = shoot(front, field, W, H, 1, "auto", false);
    assert_int_equal(none.frame.covered, 0);
    for (int i = 0; i < W * H * 4; i++) assert_true(none.frame.rgba[i] == 0);
    put_away(&none);
    put_away(&one);
    put_away(&full);
    put_away(&both);
    put_away(&plane);
    wr_scene_free(front);
    wr_field_free(field);
}

/* HC154: far from the origin the picture is the same as near it. */
static void far_away_it_is_as_near(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int k = 0; k < 4; k++) {
        Set set = some_set(&random, 3);
        WrFrameRequest request = request_of(&set);
        request.turn_deg = 0;
        Shot here = shoot_set(&request, 1, "auto");
        const WrVec3 far = { 16777216.0, -33554432.0,
                             8388608.0 }; /* so that places stay as they are */
        WrScene *moved = wr_scene_clone(set.together);
        for (int i = 0; i < moved->other_count; i++) {
            WrScene *other = wr_scene_clone(moved->others[i]);
            other->at = v3_add(other->at, far);
            wr_scene_free(moved->others[i]);
            moved->others[i] = other;
        }
        moved->at = v3_add(moved->at, far);
        moved->camera.eye = v3_add(moved->camera.eye, far);
        moved->camera.target = v3_add(moved->camera.target, far);
        for (int i = 0; i < moved->light_count; i++)
            if (moved->lights[i].kind == WR_LIGHT_POINT)
                moved->lights[i].where = v3_add(moved->lights[i].where, far);
        request.scene = moved;
        Shot there = shoot_set(&request, 1, "auto");
        int off = 0;
        for (int i = 0; i < W * H * 4; i++)
            off += fabsf(here.frame.rgba[i] - there.frame.rgba[i]) > 0.01f;
        assert_in_range(off, 0, W * H * 4 / 200);
        put_away(&there);
        put_away(&here);
        wr_scene_free(moved);
        put_set_away(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_sample_is_the_nearest_objects),
        cmocka_unit_test(nothing_depends_on_threads_kernels_or_the_plan),
        cmocka_unit_test(samples_are_those_of_a_larger_picture),
        cmocka_unit_test(parts_of_the_picture_are_the_wholes),
        cmocka_unit_test(edits_of_a_resting_view),
        cmocka_unit_test(the_reference_sees_the_same),
        cmocka_unit_test(a_pointer_finds_what_is_seen),
        cmocka_unit_test(the_hidden_costs_nothing),
        cmocka_unit_test(far_away_it_is_as_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
