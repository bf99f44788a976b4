/* Relight cache (E76): a static view with changing lights. It is filled at the second change and used from the third.
   Each picture is bit-identical to a new one, after any sequence of commands, for one object and for several. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/pool.h"
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "render/simd/simd_kernels.h"
#include "document/document.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Picture size with a packed and an unpacked tile beside each other. */
#define WIDTH 131
#define HEIGHT 37
#define STEPS 26 /* for one scene */

/* Changes of light and material only. */
static const char *const light_lines[] = {
    "light directional to=0.3,-0.2,1 index=1",
    "light directional to=-1,0.4,-0.3 strength=1.7 index=1",
    "light point at=1.3,0.7,2.1 colour=1,0.4,0.2 index=1",
    "light directional to=0.1,1,0.2 strength=0.3",
    "light directional to=1,0,0 strength=0 index=1",
    "material diffuse=0.41 specular=0",
    "material specular=0.62 shininess=17",
    "material colour=0.9,0.31,0.17 ambient=0.03",
    "material gate=off",
    "material gate=on",
    "material model=ggx roughness=0.31 metalness=0.4",
    "material model=oren-nayar roughness=0.5",
    "material model=blinn-phong tint=0.5",
    "material preset=gold",
    "environment studio turn=17",
    "environment sky turn=41 strength=0.7",
    "environment off",
    "background gradient top=0.1,0.2,0.6 bottom=0.3,0.3,0.2",
    "background plain colour=0.1,0,0.3",
    "tone soft exposure=0.7",
    "tone clip exposure=0",
    "material shadow=on",
    "material shadow=off",
    "material occlusion=on",
    "material occlusion=off",
    "light directional to=0.9,0.1,0.4 shadow=on index=1",
    "light directional to=-0.2,0.5,0.3 size=3 shadow=on",
    "light point at=1.1,-0.4,0.9 size=7",
};

/* Changes of points, normals, or other inputs of lighting; %d stands for a number. */
static const char *const other_lines[] = {
    "bump height=0.0%d",
    "bump mode=exact",
    "bump mode=blinn",
    "bump scheme=bspline",
    "bump scheme=central",
    "replicate 1.%d,2",
    "rotate 1%d,30,20",
    "camera perspective fov=3%d",
    "camera orthographic",
    "camera perspective",
    "dab 0.4,0.%d radius=9 strength=0.8",
    "dials aa=filter",
    "dials aa=point heights=8bit",
    "dials aa=supersample samples=2",
    "dials aa=point heights=float",
    "dials aa=moments",
    "dials aa=moments moments=lean footprint=anisotropic",
    "dials aa=supersample samples=3 spread=jittered",
    "dials shading=half",
    "dials shading=float rays=5",
    "light directional to=0.8,0.3,0.4 index=1",
    "grain wood drives=bump height=0.0%d",
    "grain wood drives=colour",
    "grain marble amount=0.%d",
    "grain off",
    "colouring ramp",
    "colouring off",
    "colour spots.ppm",
    "colour spots.ppm repeat=2,1.%d",
    "colour off",
    "analytic fourier terms=2,3,0.0%d",
    "analytic off",
    "object set size=0.%d",
    "object set size=0.%d,0.7,1",
};

#define COUNT(lines) (int)(sizeof(lines) / sizeof *(lines))

/* For several objects, additionally. */
static const char *const group_lines[] = {
    "object choose first",
    "object choose ring",
    "object choose box",
    "object set at=0.%d,0.2,-0.3",
    "object set at=-0.%d,0.1,0.4",
    "object hide ring",
    "object show ring",
    "object hide box",
    "object show box",
};

/* A ring around the first object, and a box that intersects it. */
static const char *const group_made[] = {
    "object set name=first",
    "object add ring at=0.3,0.2,0.1 size=0.8",
    "surface torus",
    "bump height=0.05",
    "object add box at=-0.5,-0.2,0.6",
    "surface cube",
    "rotate 20,30,10",
    "object choose first",
};

typedef struct Rig {
    WrSession *session;
    WrRenderer *renderer, *other; /* other: renders without a cache */
    WrPool *pool;
    int width;
    bool codes;
    int known;   /* pictures with lighting alone recomputed */
    int hidden;  /* of these, without shadow tests though the scene has shadows */
    int painted; /* of these, with a texture fetched again */
} Rig;

static WrFrameRequest request_of(const Rig *rig, bool keep)
{
    const WrScene *scene = doc(rig->session)->scene;
    const WrField *field = wr_document_field(doc(rig->session));
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = rig->width, .height = HEIGHT, .keep = keep
    };
    request.codes = wr_frame_codes_of(scene, true);
    request.codes.wanted = rig->codes;
    return request;
}

static const void *bytes_of(const WrFrame *frame)
{
    return frame->codes ? (const void *)frame->codes : (const void *)frame->rgba;
}

static bool knows_shadows(const WrPlan *plan)
{
    const WrPlanRow *cast = &plan->rows[WR_EFFECT_CAST], *relief = &plan->rows[WR_EFFECT_SHADOW];
    return (cast->run || relief->run) && !cast->ran && !relief->ran;
}

/* The cached picture is bit-identical to a new one. */
static void compare(Rig *rig, const char *line)
{
    WrError err = { "" };
    WrFrame rests, fresh;
    const WrFrameRequest request = request_of(rig, true), anew = request_of(rig, false);
    if (!wr_renderer_frame(rig->renderer, &request, &rests, &err)) fail_msg("%s", err.text);
    const bool known = rests.plan->rows[WR_EFFECT_STEADY].verdict == WR_VERDICT_SPARED;
    rig->known += known;
    rig->hidden += known && knows_shadows(rests.plan);
    rig->painted +=
        known && (rests.plan->rows[WR_EFFECT_COLOUR].run || rests.plan->rows[WR_EFFECT_FACETS].run);
    if (!wr_renderer_frame(rig->other, &anew, &fresh, &err)) fail_msg("%s", err.text);
    const size_t pixel = rig->codes ? sizeof(uint32_t) : 4 * sizeof(float);
    const size_t count = (size_t)rig->width * HEIGHT * pixel;
    if (memcmp(bytes_of(&rests), bytes_of(&fresh), count) != 0)
        fail_msg("%s: the resting picture is another (%s; %s)", line,
                 rests.plan->rows[WR_EFFECT_STEADY].reason,
                 rests.plan->rows[WR_EFFECT_CAST].reason);
    assert_int_equal(rests.covered, fresh.covered);
}

static void step(Rig *rig, const char *format, int digit)
{
    char line[200];
    const char *place = strstr(format, "%d");
    if (place)
        snprintf(line, sizeof line, "%.*s%d%s", (int)(place - format), format, digit, place + 2);
    else snprintf(line, sizeof line, "%s", format);
    must_run(rig->session, line);
    compare(rig, line);
}

/* Small pictures with random pixels. */
static void write_pictures(void)
{
    unsigned seed = 5;
    FILE *rough = fopen("rough.pgm", "w"), *spots = fopen("spots.ppm", "w");
    assert_true(rough && spots);
    fprintf(rough, "P2 7 5 255\n");
    fprintf(spots, "P3 7 5 255\n");
    for (int i = 0; i < 4 * 7 * 5; i++) {
        seed = seed * 1664525u + 1013904223u;
        fprintf(i % 4 ? spots : rough, "%u\n", seed >> 24);
    }
    assert_int_equal(fclose(rough) | fclose(spots), 0);
}

static Rig rig_of(int width, bool codes)
{
    WrError err = { "" };
    Rig rig = {
        .session = wr_session_new(NULL), .pool = wr_pool_new(2), .width = width, .codes = codes
    };
    rig.renderer = wr_renderer_new(rig.pool, NULL, &err);
    rig.other = wr_renderer_new(rig.pool, NULL, &err);
    must_run(rig.session, "table 75x52");
    must_run(rig.session, "noise perlin");
    must_run(rig.session, "dials gloss=4 horizons=8"); /* faster */
    return rig;
}

static void free_rig(Rig *rig)
{
    wr_renderer_free(rig->renderer);
    wr_renderer_free(rig->other);
    wr_session_free(rig->session);
    wr_pool_free(rig->pool);
}

/* Random lines, four of five of them about light; others: two lists of further lines. */
static void wander(Rig *rig, unsigned seed, const char *const *others, int count)
{
    for (int i = 0; i < STEPS; i++) {
        seed = seed * 1664525u + 1013904223u;
        const bool light = (seed >> 24) % 5 != 0;
        const int lines = light ? COUNT(light_lines) : COUNT(other_lines) + count;
        const int which = (int)((seed >> 12) % (unsigned)lines);
        const char *line = light                        ? light_lines[which]
                           : which < COUNT(other_lines) ? other_lines[which]
                                                        : others[which - COUNT(other_lines)];
        step(rig, line, 1 + (int)(seed >> 28) % 9);
    }
}

static void try_surface(const char *surface, int number, int *known, int *painted)
{
    char line[100];
    Rig rig = rig_of(number % 2 ? WIDTH : 300, number % 3 != 0);
    snprintf(line, sizeof line, "surface %s", surface);
    must_run(rig.session, line);
    if (number % 3 == 1) must_run(rig.session, "colour spots.ppm repeat=1.3,2");
    wander(&rig, 977u + (unsigned)number, NULL, 0);
    *known += rig.known, *painted += rig.painted;
    free_rig(&rig);
}

static void light_alone_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "sphere",   "torus", "plane", "bezier",
                                            "cylinder", "cube",  "cone",  "disc" };
    int known = 0, painted = 0;
    write_pictures();
    for (int i = 0; i < COUNT(surfaces); i++) try_surface(surfaces[i], i, &known, &painted);
    if (known < STEPS || painted < STEPS / 4)
        fail_msg("only %d pictures of %d worked out light alone, %d of those with a picture", known,
                 8 * STEPS, painted);
}

/* Several overlapping objects, one of them painted. */
static void light_alone_of_several_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const first[] = { "sphere", "bezier", "torus", "cylinder" };
    int known = 0, painted = 0;
    write_pictures();
    for (int i = 0; i < COUNT(first); i++) {
        char line[100];
        Rig rig = rig_of(i % 2 ? WIDTH : 300, i % 3 != 0);
        snprintf(line, sizeof line, "surface %s", first[i]);
        must_run(rig.session, line);
        for (int k = 0; k < COUNT(group_made); k++) must_run(rig.session, group_made[k]);
        if (i % 2) must_run(rig.session, "colour spots.ppm");
        wander(&rig, 1977u + (unsigned)i, group_lines, COUNT(group_lines));
        known += rig.known, painted += rig.painted;
        free_rig(&rig);
    }
    if (known < STEPS || painted < STEPS / 4)
        fail_msg("only %d pictures of %d worked out light alone, %d of those with a picture", known,
                 4 * STEPS, painted);
}

/* A line, or "width N" for later pictures; and the expected number of pictures with lighting alone recomputed. */
typedef struct Step {
    const char *line;
    int known;
    int hidden; /* of these, without shadow tests */
} Step;

static void walk(Rig *rig, const Step *steps, int count)
{
    for (int i = 0; i < count; i++) {
        if (sscanf(steps[i].line, "width %d", &rig->width) != 1)
            must_run(rig->session, steps[i].line);
        compare(rig, steps[i].line);
        if (rig->known != steps[i].known)
            fail_msg("step %d, %s: %d pictures worked out light alone, not %d", i, steps[i].line,
                     rig->known, steps[i].known);
        if (rig->hidden != steps[i].hidden)
            fail_msg("step %d, %s: %d pictures asked for no shadow, not %d", i, steps[i].line,
                     rig->hidden, steps[i].hidden);
    }
    free_rig(rig);
}

/* The second change fills the cache, the third uses it; an edit of the table or the view clears it. */
static void light_alone_is_worked_out(void **state)
{
    (void)state;
    static const Step steps[] = { { "light directional to=0.3,0.1,-1 index=1", 0,
                                    0 }, /* from behind: dark runs are cached too */
                                  { "material diffuse=0.6", 0, 0 },
                                  { "material diffuse=0.7", 1, 0 },
                                  { "light directional to=1,1,2 index=1", 2, 0 },
                                  { "dab 0.5,0.5 radius=9", 2, 0 },
                                  { "material diffuse=0.6", 2, 0 },
                                  { "material specular=0.5", 3, 0 },
                                  { "camera perspective fov=31", 3, 0 },
                                  { "material specular=0.25", 3, 0 },
                                  { "material specular=0.75", 4, 0 },
                                  { "bump height=0.07", 4, 0 },
                                  { "material specular=0.3", 4, 0 },
                                  { "environment studio turn=12", 5, 0 },
                                  { "environment turn=31", 6, 0 },
                                  { "width 120", 6, 0 },
                                  { "environment turn=33", 6, 0 },
                                  { "environment turn=34", 7, 0 },
                                  { "dials arithmetic=fast", 7, 0 } };
    Rig rig = rig_of(257, true);
    must_run(rig.session, "surface torus");
    walk(&rig, steps, COUNT(steps));
}

/* With several objects: all are cached at once, including one new in the list of changes. */
static void light_alone_of_several_is_worked_out(void **state)
{
    (void)state;
    static const Step steps[] = { { "object hide ring", 0, 0 },
                                  { "material diffuse=0.6", 0, 0 },
                                  { "material diffuse=0.7", 1, 0 },
                                  { "object choose box", 2, 0 },
                                  { "material colour=0.2,0.4,0.9", 3, 0 },
                                  { "light directional to=1,1,2 index=1", 4, 0 },
                                  { "object remove ring", 4, 0 },
                                  { "material specular=0.5", 4, 0 },
                                  { "material specular=0.1", 5, 0 },
                                  { "object set at=-0.1,0.05,0.2", 5, 0 },
                                  { "material specular=0.4", 5, 0 },
                                  { "material specular=0.6", 6, 0 },
                                  { "object hide box", 6, 0 },
                                  { "material specular=0.2", 6, 0 },
                                  { "material specular=0.3", 7, 0 },
                                  { "object show box", 7, 0 } };
    Rig rig = rig_of(257, true);
    must_run(rig.session, "surface sphere");
    must_run(rig.session, "camera perspective eye=0,0.3,6 fov=40");
    for (int k = 0; k < COUNT(group_made); k++) must_run(rig.session, group_made[k]);
    walk(&rig, steps, COUNT(steps));
}

/* Textures and solid textures are fetched again, so changing them counts as a change of light; adding or removing a
   texture does not. */
static void pictures_and_roughness_are_light(void **state)
{
    (void)state;
    static const Step steps[] = { { "roughness rough.pgm", 0, 0 },
                                  { "material metalness=0.6", 0, 0 },
                                  { "environment studio turn=40", 1, 0 },
                                  { "colour spots.ppm", 2, 0 }, /* u and v are cached */
                                  { "material metalness=0.3", 3, 0 },
                                  { "colour spots.ppm repeat=3,1.5", 4, 0 },
                                  { "roughness rough.pgm repeat=0.7,2", 5, 0 },
                                  { "grain marble drives=colour", 6, 0 },
                                  { "grain marble amount=0.3", 7, 0 },
                                  { "environment off", 8, 0 },
                                  { "roughness off", 9, 0 },
                                  { "grain wood drives=colour+roughness", 10, 0 },
                                  { "grain granite rough_light=0.9 amount=3", 11, 0 },
                                  { "grain checker drives=roughness", 12, 0 },
                                  { "grain off", 13, 0 },
                                  { "grain marble drives=bump height=0.05", 13, 0 },
                                  { "material metalness=0.5", 13, 0 },
                                  { "material metalness=0.4", 14, 0 },
                                  { "grain marble amount=0.7", 14, 0 } };
    Rig rig = rig_of(400, false);
    write_pictures();
    must_run(rig.session, "surface sphere");
    must_run(rig.session, "material model=ggx");
    must_run(rig.session, "camera orthographic size=0.25"); /* rows of whole tiles */
    walk(&rig, steps, COUNT(steps));
}

/* Visibility of a light stays cached while it is valid: of the relief, and of other objects. */
static void shadows_stay_with_their_lamps(void **state)
{
    (void)state;
    static const Step steps[] = {
        { "material shadow=on", 0, 0 },
        { "material diffuse=0.6", 0, 0 },
        { "material specular=0.35", 1, 1 },
        { "light directional to=1,0.2,0.1 shadow=on index=1", 2, 1 },
        { "material colour=0.9,0.5,0.2", 3, 2 },
        { "light point at=-1,1.2,0.7 size=8 shadow=on", 4, 2 },
        { "light point at=-1,1.2,0.7 size=8 strength=0.6 shadow=on index=2", 5, 3 },
        { "dials rays=8", 6, 3 }, /* one per horizon direction */
        { "light point at=-1,1.2,0.7 size=2 strength=0.6 shadow=on index=2", 7, 3 },
        { "material occlusion=on", 8, 4 },
        { "material model=ggx", 9, 5 },
        { "light directional to=1,0,0 strength=0 index=2", 10, 6 },
        { "dab 0.4,0.6 radius=7", 10, 6 },
        { "material ambient=0.2", 10, 6 },
        { "material ambient=0.3", 11, 7 },
        { "object choose ring", 12, 8 },
        { "material shadow=on", 13, 8 }
    };
    Rig rig = rig_of(400, true);
    must_run(rig.session, "camera orthographic size=0.25"); /* points are needed for shadows only */
    must_run(rig.session, "surface sphere");
    must_run(rig.session, "light directional to=0.8,0.3,0.5 shadow=on");
    must_run(rig.session, "bump height=0.06");
    must_run(rig.session, "object set name=first");
    must_run(rig.session, "object add ring at=0.6,0.4,0.5 size=0.7");
    must_run(rig.session, "surface torus");
    must_run(rig.session, "bump height=0.03");
    must_run(rig.session, "object choose first");
    walk(&rig, steps, COUNT(steps));
}

/* Footprints, highlight widths, and every sample of a pixel are cached. */
static void filtered_and_many_samples_are_noted(void **state)
{
    (void)state;
    static const Step steps[] = { { "material shininess=31", 0, 0 },
                                  { "material specular=0.4", 0, 0 },
                                  { "material specular=0.5", 1, 0 },
                                  { "material specular=0", 2, 0 },
                                  { "material specular=0.3", 3, 0 },
                                  { "colour spots.ppm repeat=3,2", 3, 0 },
                                  { "material diffuse=0.7", 3, 0 },
                                  { "colour spots.ppm repeat=2,7", 4, 0 },
                                  { "dials aa=moments moments=lean", 5, 0 },
                                  { "material model=ggx roughness=0.3", 6, 0 },
                                  { "environment studio turn=20", 7, 0 },
                                  { "dials aa=supersample samples=5", 7, 0 },
                                  { "material roughness=0.4", 7, 0 },
                                  { "material roughness=0.5", 8, 0 },
                                  { "dials spread=jittered", 8, 0 },
                                  { "light directional to=1,0.4,0.3", 8, 0 },
                                  { "light directional to=1,0.4,0.1 index=1", 9, 0 },
                                  { "dials aa=adaptive", 9, 0 },
                                  { "material diffuse=0.5", 9, 0 },
                                  { "material diffuse=0.6", 9, 0 } };
    Rig rig = rig_of(119, false);
    write_pictures();
    must_run(rig.session, "surface torus");
    must_run(rig.session, "replicate 7,5");
    must_run(rig.session, "dials aa=moments");
    walk(&rig, steps, COUNT(steps));
}

/* Vector kernels recompute a plain sphere as fast as reading it from memory. */
static void many_samples_of_a_plain_sphere_are_not_kept(void **state)
{
    (void)state;
    static const Step steps[] = { { "dials arithmetic=fast aa=supersample samples=3", 0, 0 },
                                  { "material diffuse=0.7", 0, 0 },
                                  { "material diffuse=0.6", 0, 0 },
                                  { "material diffuse=0.55", 0, 0 },
                                  { "material model=ggx roughness=0.3", 0, 0 },
                                  { "material diffuse=0.5", 0, 0 },
                                  { "material diffuse=0.45", 1, 0 } };
    WrError err = { "" };
    const WrKernels *fast = wr_kernels_get("auto", true, &err);
    if (!fast || !wr_wide_of(fast)) skip(); /* this processor has no such kernels */
    Rig rig = rig_of(77, false);
    must_run(rig.session, "surface sphere");
    must_run(rig.session, "replicate 4,2");
    walk(&rig, steps, COUNT(steps));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_alone_gives_the_same_bits),
        cmocka_unit_test(light_alone_of_several_gives_the_same_bits),
        cmocka_unit_test(light_alone_is_worked_out),
        cmocka_unit_test(light_alone_of_several_is_worked_out),
        cmocka_unit_test(pictures_and_roughness_are_light),
        cmocka_unit_test(shadows_stay_with_their_lamps),
        cmocka_unit_test(filtered_and_many_samples_are_noted),
        cmocka_unit_test(many_samples_of_a_plain_sphere_are_not_kept),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
