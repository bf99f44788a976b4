/* A view that rests but for its light (E76): n' and P are noted at the second change and used from the third on, and each
   picture has the bits of a whole new one, whatever commands came between. */
#include "test.h"
#include "test_folder.h"
#include "test_session_help.h"

#include "base/pool.h"
#include "render/frame.h"
#include "document/document.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define WIDTH                                                                                      \
    131 /* of a picture: a tile that is packed, and one that is not, beside each other with 300 */
#define STEPS 26 /* of one scene */

/* Light and material alone. */
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
};

/* What moves points or normals, or what light then looks at besides them; a number takes %d. */
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
    "material shadow=on",
    "material shadow=off",
    "light directional to=0.9,0.1,0.4 shadow=on index=1",
    "light directional to=0.8,0.3,0.4 index=1",
    "grain wood",
    "grain off",
    "colouring ramp",
    "colouring off",
    "analytic fourier terms=2,3,0.0%d",
    "analytic off",
    "object set size=0.%d",
};

#define COUNT(lines) (int)(sizeof(lines) / sizeof *(lines))

typedef struct Rig {
    WrSession *session;
    WrRenderer *renderer;
    WrPool *pool;
    int width;
    bool codes;
    int known; /* pictures that worked out light alone */
} Rig;

static WrFrameRequest request_of(const Rig *rig, bool keep)
{
    const WrScene *scene = doc(rig->session)->scene;
    WrFrameRequest request = { .field = wr_document_field(doc(rig->session)),
                               .scene = scene,
                               .width = rig->width,
                               .height = 93,
                               .keep = keep };
    request.codes = wr_frame_codes_of(scene, true);
    request.codes.wanted = rig->codes;
    return request;
}

static const void *bytes_of(const WrFrame *frame)
{
    return frame->codes ? (const void *)frame->codes : (const void *)frame->rgba;
}

/* The picture that rests has the bits of one by a renderer that saw nothing before. */
static void compare(Rig *rig, const char *line)
{
    WrError err = { "" };
    WrFrame rests, fresh;
    const WrFrameRequest request = request_of(rig, true), anew = request_of(rig, false);
    if (!wr_renderer_frame(rig->renderer, &request, &rests, &err)) fail_msg("%s", err.text);
    rig->known += rests.plan->rows[WR_EFFECT_STEADY].verdict == WR_VERDICT_SPARED;
    WrRenderer *other = wr_renderer_new(rig->pool, NULL, &err);
    if (!wr_renderer_frame(other, &anew, &fresh, &err)) fail_msg("%s", err.text);
    const size_t pixel = rig->codes ? sizeof(uint32_t) : 4 * sizeof(float);
    const size_t count = (size_t)rig->width * 93 * pixel;
    if (memcmp(bytes_of(&rests), bytes_of(&fresh), count) != 0)
        fail_msg("%s: the resting picture is another", line);
    assert_int_equal(rests.covered, fresh.covered);
    wr_renderer_free(other);
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

static void try_surface(const char *surface, int number, int *known)
{
    char line[100];
    WrError err = { "" };
    Rig rig = { .session = wr_session_new(NULL), .pool = wr_pool_new(2) };
    rig.width = number % 2 ? WIDTH : 300;
    rig.codes = number % 3 != 0;
    rig.renderer = wr_renderer_new(rig.pool, NULL, &err);
    must_run(rig.session, "table 75x52");
    must_run(rig.session, "noise perlin");
    snprintf(line, sizeof line, "surface %s", surface);
    must_run(rig.session, line);
    unsigned seed = 977u + (unsigned)number;
    for (int i = 0; i < STEPS; i++) {
        seed = seed * 1664525u + 1013904223u;
        const bool light = (seed >> 24) % 5 != 0;
        const int count = light ? COUNT(light_lines) : COUNT(other_lines);
        const int which = (int)((seed >> 12) % (unsigned)count);
        step(&rig, light ? light_lines[which] : other_lines[which], 1 + (int)(seed >> 28) % 9);
    }
    *known += rig.known;
    wr_renderer_free(rig.renderer);
    wr_session_free(rig.session);
    wr_pool_free(rig.pool);
}

static void light_alone_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "sphere",   "torus", "plane", "bezier",
                                            "cylinder", "cube",  "cone",  "disc" };
    int known = 0;
    for (int i = 0; i < COUNT(surfaces); i++) try_surface(surfaces[i], i, &known);
    if (known < STEPS) fail_msg("only %d pictures of %d worked out light alone", known, 8 * STEPS);
}

/* The second change of light notes, the third uses it; an edit of the table, or of the view, forgets it. */
static void light_alone_is_worked_out(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int known; /* pictures so far that were */
    } steps[] = { { "light directional to=0.3,0.1,-1 index=1",
                    0 }, /* from behind: dark runs are noted too */
                  { "material diffuse=0.6", 0 },
                  { "material diffuse=0.7", 1 },
                  { "light directional to=1,1,2 index=1", 2 },
                  { "dab 0.5,0.5 radius=9", 2 },
                  { "material diffuse=0.6", 2 },
                  { "material specular=0.5", 3 },
                  { "camera perspective fov=31", 3 },
                  { "material specular=0.25", 3 },
                  { "material specular=0.75", 4 },
                  { "bump height=0.07", 4 },
                  { "material specular=0.3", 4 },
                  { "environment studio turn=12", 5 },
                  { "environment turn=31", 6 } };
    WrError err = { "" };
    Rig rig = {
        .session = wr_session_new(NULL), .pool = wr_pool_new(2), .width = 257, .codes = true
    };
    rig.renderer = wr_renderer_new(rig.pool, NULL, &err);
    must_run(rig.session, "table 75x52");
    must_run(rig.session, "noise perlin");
    must_run(rig.session, "surface torus");
    for (int i = 0; i < COUNT(steps); i++) {
        must_run(rig.session, steps[i].line);
        compare(&rig, steps[i].line);
        if (rig.known != steps[i].known)
            fail_msg("step %d, %s: %d pictures worked out light alone, not %d", i, steps[i].line,
                     rig.known, steps[i].known);
    }
    wr_renderer_free(rig.renderer);
    wr_session_free(rig.session);
    wr_pool_free(rig.pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_alone_gives_the_same_bits),
        cmocka_unit_test(light_alone_is_worked_out),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
