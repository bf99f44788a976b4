/* render_sets.h - several random objects, separately and together, for tests of multi-object pictures. Include
   after test.h. */
#pragma once
#include "scene/objects.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#define W 90
#define H 61
#define MAX_MOST 5

/* Objects as separate scenes, and all of them in one. */
typedef struct Set {
    WrScene *alone[MAX_MOST]; /* with the camera and lights of the whole */
    WrField *field[MAX_MOST];
    WrScene *together;
    const WrField *fields[MAX_MOST];
    int count;
} Set;

static inline double between(TestRandom *random, double low, double high)
{
    return low + (high - low) * test_random(random);
}

static inline WrScene *some_object(TestRandom *random)
{
    static const char *const surfaces[] = { "sphere", "plane", "cube",     "torus",
                                            "ribbon", "cone",  "cylinder", "bezier" };
    WrScene *scene = scene_of(surfaces[(int)(8 * test_random(random))]);
    scene->at = (WrVec3){ between(random, -0.9, 0.9), between(random, -0.7, 0.7),
                          between(random, -0.9, 0.9) };
    scene->size = between(random, 0.3, 1.4);
    scene->posed = test_random(random) < 0.7;
    scene->rotate_deg = (WrVec3){ between(random, -180, 180), between(random, -180, 180),
                                  between(random, -180, 180) };
    scene->height = test_random(random) < 0.2 ? 0 : 0.06;
    scene->bump = (WrBumpMode)(WR_BUMP_COUNT * test_random(random));
    scene->scheme = (WrScheme)(WR_SCHEME_COUNT * test_random(random));
    scene->replicate_u = (int)between(random, 1, 4);
    scene->material.colour = (WrVec3){ test_random(random), test_random(random), 0.5 };
    if (test_random(random) < 0.2) scene->material.diffuse = scene->material.specular = 0;
    return scene;
}

static inline Set some_set(TestRandom *random, int count)
{
    Set set = { .count = count };
    WrScene *world = wr_scene_new();
    world->camera = (WrCamera){ .orthographic = test_random(random) < 0.4,
                                .eye = { between(random, -2, 2), between(random, -2, 2), 5 },
                                .target = { 0.1, -0.05, 0.02 },
                                .up = { 0, 1, 0 },
                                .fov_deg = 33,
                                .size = 3.1 };
    if (test_random(random) < 0.5) {
        world->lights[0].kind = WR_LIGHT_POINT;
        world->lights[0].where = (WrVec3){ 0.5, 2, 2.5 };
    }
    for (int i = 0; i < count; i++) {
        set.alone[i] = some_object(random);
        wr_scene_take_shared(set.alone[i], world);
        set.field[i] = random_field(17 + (int)(80 * test_random(random)), 23 + i, 5 + (uint64_t)i);
        set.fields[i] = set.field[i];
    }
    const int at_hand = (int)(count * test_random(random));
    set.together = wr_scene_clone(set.alone[at_hand]);
    set.together->others = wr_alloc((size_t)count, sizeof *set.together->others);
    for (int i = 0; i < count; i++)
        if (i != at_hand)
            set.together->others[set.together->other_count++] = wr_scene_share(set.alone[i]);
    set.together->chosen = at_hand;
    wr_scene_free(world);
    return set;
}

static inline void put_set_away(Set *set)
{
    for (int i = 0; i < set->count; i++) {
        wr_scene_free(set->alone[i]);
        wr_field_free(set->field[i]);
    }
    wr_scene_free(set->together);
}

static inline WrFrameRequest request_of(const Set *set)
{
    return (WrFrameRequest){ .field = set->field[0],
                             .fields = set->fields,
                             .scene = set->together,
                             .width = W,
                             .height = H,
                             .turn_deg = 15 };
}

static inline Shot shoot_set(const WrFrameRequest *request, int threads, const char *isa)
{
    WrError err = { "" };
    Shot shot = { .pool = wr_pool_new(threads) };
    shot.renderer = wr_renderer_new(shot.pool, isa, &err);
    if (!shot.renderer || !wr_renderer_frame(shot.renderer, request, &shot.frame, &err))
        fail_msg("%s", err.text);
    return shot;
}
