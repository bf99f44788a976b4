/* Materials, light presets, stock models and starters: each row or file works, and its picture is neither black nor
   flat. */
#include "test.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/light_preset.h"
#include "scene/material_preset.h"
#include "scene/scene.h"
#include "scene/stock_model.h"
#include "session_help.h"
#include "surface/triangles.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- statistics of a picture ---- */

typedef struct Light {
    double mean, spread, dark; /* luminance: mean, standard deviation, the 5th of 100 from below */
    int covered;
} Light;

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double luma(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static Light light_of(WrSession *session, int width, int height)
{
    static float value[97 * 97];
    WrFrame frame;
    WrError err;
    Light light = { 0 };
    double sum = 0, squares = 0;
    if (!wr_session_frame(session, width, height, 0, &frame, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < width * height; i++)
        if (frame.rgba[4 * i + 3] > 0.99f) {
            value[light.covered] = (float)luma(frame.rgba + 4 * i);
            sum += (double)value[light.covered], squares += pow((double)value[light.covered++], 2);
        }
    assert_in_range(light.covered, 1, 97 * 97);
    qsort(value, (size_t)light.covered, sizeof *value, by_value);
    light.mean = sum / light.covered;
    light.spread = sqrt(fmax(squares / light.covered - light.mean * light.mean, 0));
    light.dark = (double)value[light.covered / 20];
    return light;
}

static void check_light(const Light *light, double contrast, double dark, const char *name)
{
    if (light->mean < 0.05 || light->mean > 0.8)
        fail_msg("%s: mean luminance %.3f, expected 0.05 to 0.8", name, light->mean);
    if (light->spread < contrast * light->mean)
        fail_msg("%s: contrast %.3f of a mean of %.3f: flat", name, light->spread, light->mean);
    if (light->dark < dark) fail_msg("%s: its dark side is black: %.4f", name, light->dark);
}

/* ---- tables ---- */

static void twelve_materials_are_there_and_keep_the_reliefs_occlusion(void **state)
{
    (void)state;
    static const char *const wanted[] = { "clay",    "stone",  "plaster", "leather", "gold",
                                          "steel",   "bronze", "wood",    "rubber",  "porcelain",
                                          "wax",     "ice",    "usual",   "brick",   "skin",
                                          "plastic", "metal",  "copper" };
    assert_int_equal(sizeof wanted / sizeof *wanted, WR_MATERIAL_PRESETS);
    WrSession *session = session_of(
        (const char *const[]){ "table 5x3", "surface sphere", "light preset studio",
                               "material occlusion=on", "dials gloss=4 samples=1", NULL });
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        char line[64];
        snprintf(line, sizeof line, "material preset=%s", wanted[i]);
        must_run(session, line);
        const WrMaterial *m = &doc(session)->scene->material;
        assert_true(m->occlusion && !m->shadow);
        assert_true(m->colour.x <= 1 && m->colour.y <= 1 && m->colour.z <= 1);
        if (i % test_step(3, 9) != 0) continue; /* blurred surroundings are dear */
        Light light = light_of(session, 21, 23);
        if (light.mean < 0.015) fail_msg("%s: %.4f: black", wanted[i], light.mean);
    }
    wr_session_free(session);
}

static void light_presets_replace_all_light_and_keep_a_readable_dark_side(void **state)
{
    (void)state;
    for (int i = 0; i < WR_LIGHT_PRESETS; i++) {
        char line[64];
        snprintf(line, sizeof line, "light preset %s", wr_light_presets[i].name);
        WrSession *session = session_of(
            (const char *const[]){ "table 5x3", "surface sphere", "environment sky turn=70",
                                   "light point at=3,3,3", line, NULL });
        assert_int_equal(wr_light_preset_now(doc(session)->scene), i);
        Light light = light_of(session, 61, 53);
        check_light(&light, 0.12, 0.02, wr_light_presets[i].name);
        must_run(session, "undo");
        assert_int_equal(doc(session)->scene->light_count, 1);
        assert_int_equal(wr_light_preset_now(doc(session)->scene), -1);
        wr_session_free(session);
    }
}

static void a_stock_model_is_one_step_about_two_units_wide(void **state)
{
    (void)state;
    Said said = { "" };
    for (int i = 0; i < WR_STOCK_MODELS; i += test_step(1, 4)) {
        char line[64];
        WrSession *session = listening(&said);
        must_run(session, "surface torus");
        must_run(session, "replicate 5,2");
        const int before = wr_session_history_position(session);
        snprintf(line, sizeof line, "model %s", wr_stock_models[i].name);
        must_run(session, line);
        assert_int_equal(wr_session_history_position(session), before + 1);
        const WrScene *scene = doc(session)->scene;
        assert_int_equal(scene->shape.kind, WR_SURFACE_mesh);
        assert_in_range(scene->triangles->triangle_count, 400, 20000);
        const double radius = wr_shape_radius(&scene->shape);
        if (radius < 0.9 || radius > 2.6) fail_msg("%s: radius %g", line, radius);
        must_run(session, "light preset studio");
        must_run(session, "dials rays=0");
        Light light = light_of(session, 37, 41);
        check_light(&light, 0.08, 0.01, line);
        must_run(session, "undo 3");
        assert_int_equal(doc(session)->scene->shape.kind, WR_SURFACE_torus);
        assert_true(doc(session)->scene->replicate_u == 5);
        wr_session_free(session);
    }
    assert_string_equal(said.text, "");
}

/* ---- starters ---- */

/* Runs the script on a table of half the size, to save time. */
static void run_half(WrSession *session, const char *path)
{
    char *text;
    size_t length;
    int side = 0, across, down;
    WrError err;
    if (!wr_file_read(path, 1 << 20, &text, &length, &err)) fail_msg("%s", err.text);
    for (char *at = text, *next; *at; at = next) {
        next = at + strcspn(at, "\n");
        if (*next) *next++ = '\0';
        if (sscanf(at, "table %dx%d", &across, &down) == 2) {
            char line[64];
            side = across / 2;
            snprintf(line, sizeof line, "table %dx%d%s", side, down / 2,
                     strchr(at + 6, ' ') ? strchr(at + 6, ' ') : "");
            must_run(session, line);
        } else must_run(session, at);
    }
    assert_in_range(side, 128, 512);
    wr_free(text);
}

/* The picture of the dialog has about the starter's light: it is not one of an earlier version. */
static void check_picture(const char *script, double mean)
{
    char path[4096];
    double sum = 0;
    WrError err;
    snprintf(path, sizeof path, "%.*sjpg", (int)(strlen(script) - strlen("wrinkle")), script);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s; samples/starters/pictures.sh makes it", err.text);
    const size_t count = (size_t)image->width * (size_t)image->height;
    assert_int_equal(image->channels, 3);
    for (size_t i = 0; i < count; i++) {
        float rgb[3];
        for (int c = 0; c < 3; c++) rgb[c] = wr_srgb_decode(image->data[3 * i + (size_t)c]);
        sum += luma(rgb);
    }
    wr_image_free(image);
    if (fabs(sum / (double)count - mean) > 0.06)
        fail_msg("%s: mean luminance %.3f, the starter has %.3f: run samples/starters/pictures.sh",
                 path, sum / (double)count, mean);
}

/* Mean luminance of the whole picture over the background, as files show it. */
static double shown_mean(WrSession *session)
{
    WrFrame frame;
    double sum = 0;
    const WrScene *scene = doc(session)->scene;
    assert_true(wr_session_frame(session, 41, 41, 0, &frame, NULL));
    for (int i = 0; i < 41 * 41; i++) {
        float rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = frame.rgba[4 * i + c] +
                     (1 - frame.rgba[4 * i + 3]) * (float)scene->background.top[c];
        wr_tone_colour(&scene->tone, rgb);
        sum += luma(rgb);
    }
    return sum / (41 * 41);
}

static void one_starter(const char *path)
{
    Said said = { "" };
    WrSession *session = listening(&said);
    run_half(session, path);
    must_run(session, "dials rays=0 horizons=4 samples=1 gloss=4");
    assert_int_equal(wr_light_preset_now(doc(session)->scene), 0);
    const WrLayer *top = &doc(session)->layers[doc(session)->active];
    if (top->line) fail_msg("%s: its active layer cannot be painted on", path);
    assert_int_equal(doc(session)->active, doc(session)->layer_count - 1);
    assert_in_range(doc(session)->layer_count, 4, 20);
    Light light = light_of(session, 41, 41);
    check_light(&light, 0.2, 0.003, path);
    check_picture(path, shown_mean(session));
    wr_session_free(session);
    if (strstr(said.text, "not ") || strstr(said.text, "missing"))
        fail_msg("%s: %s", path, said.text);
}

static void every_starter_opens_and_looks_like_its_picture(void **state)
{
    (void)state;
    WrText path = { 0 };
    int count = 0;
    const char *name;
    assert_true(wr_data_find("samples/starters", &path));
    WrFolder *folder = wr_folder_open(wr_text_get(&path));
    while ((name = wr_folder_next(folder)) != NULL) {
        char ending[16];
        if (strcmp(wr_path_ending(name, ending), "wrinkle") != 0) continue;
        char *script = wr_path_join(wr_text_get(&path), name);
        if (count++ % test_step(1, 4) == 0) one_starter(script);
        wr_free(script);
    }
    wr_folder_close(folder);
    wr_text_fini(&path);
    assert_in_range(count, 8, 32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(twelve_materials_are_there_and_keep_the_reliefs_occlusion),
        cmocka_unit_test(light_presets_replace_all_light_and_keep_a_readable_dark_side),
        cmocka_unit_test(a_stock_model_is_one_step_about_two_units_wide),
        cmocka_unit_test(every_starter_opens_and_looks_like_its_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
