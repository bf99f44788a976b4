/* Display views: codes of a configuration that the test writes, against its formula in double precision. */
#include "test.h"
#include "test_folder.h"

#include "command/command_line.h"
#include "document/document_file.h"
#include "image/image.h"
#include "session_help.h"

/* A matrix that mixes channels, then a power: codes = (M light)^(1 / 1.7). */
static const double mix[3][3] = { { 0.7, 0.2, 0.05 }, { 0.1, 0.85, 0.02 }, { 0.03, 0.3, 0.6 } };
#define POWER 1.7

static const char config[] =
    "ocio_profile_version: 2\n"
    "roles: {default: light, scene_linear: light}\n"
    "file_rules:\n"
    "  - !<Rule> {name: Default, colorspace: light}\n"
    "displays:\n"
    "  screen:\n"
    "    - !<View> {name: Odd, colorspace: odd}\n"
    "    - !<View> {name: As it is, colorspace: light}\n"
    "  wall:\n"
    "    - !<View> {name: As it is, colorspace: light}\n"
    "colorspaces:\n"
    "  - !<ColorSpace> {name: light}\n"
    "  - !<ColorSpace> {name: half, from_scene_reference: !<MatrixTransform> {matrix: "
    "[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}}\n"
    "  - !<ColorSpace>\n"
    "    name: odd\n"
    "    from_scene_reference: !<GroupTransform>\n"
    "      children:\n"
    "        - !<MatrixTransform> {matrix: [0.7, 0.2, 0.05, 0, 0.1, 0.85, 0.02, 0, 0.03, 0.3, 0.6, "
    "0, 0, 0, 0, 1]}\n"
    "        - !<ExponentTransform> {value: [1.7, 1.7, 1.7, 1], direction: inverse}\n";

static void write_config(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(config, file) >= 0 && fclose(file) == 0);
}

static const char *const scene[] = { "table 40x28",
                                     "noise perlin cells=5 octaves=3 seed=3 amplitude=0.4",
                                     "surface sphere",
                                     "bump height=0.2",
                                     "background plain colour=0.1,0.3,0.9",
                                     "material colour=0.9,0.5,0.3",
                                     "light directional to=0.4,0.2,1 strength=1.4",
                                     NULL };

/* A session that may write files. */
static WrSession *session(Said *said)
{
    WrSession *s = listening(said);
    for (int i = 0; scene[i]; i++) must_run(s, scene[i]);
    return s;
}

static WrImage *rendered(WrSession *s, const char *line, const char *path)
{
    WrError err;
    must_run(s, line);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

/* The code of a channel for linear light, by the formula of the configuration. */
static double expected(const double light[3], int c)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += mix[c][k] * light[k];
    sum = sum > 0 ? pow(sum, 1 / POWER) : 0;
    return 255 * (sum < 1 ? sum : 1);
}

/* Every pixel, from the light of the same picture as floats. factor: of exposure and colour space. */
static void check_codes(const WrImage *codes, const WrImage *light, double factor)
{
    static const double behind[3] = { 0.1, 0.3, 0.9 };
    int apart = 0;
    assert_int_equal(codes->width, light->width);
    for (int y = 0; y < light->height; y++)
        for (int x = 0; x < light->width; x++) {
            const size_t at = (size_t)y * (size_t)light->width + (size_t)x;
            const float *rgba = light->data + 4 * at;
            double sum[3];
            for (int c = 0; c < 3; c++) sum[c] = factor * (rgba[c] + (1 - rgba[3]) * behind[c]);
            for (int c = 0; c < 3; c++) {
                const double code = 255 * codes->data[(size_t)codes->channels * at + (size_t)c];
                assert_near(code, expected(sum, c), 0.51); /* rounding, and that of the floats */
                apart += fabs(code - expected(sum, c)) > 0.25;
            }
        }
    assert_true(apart > 100); /* codes are rounded, so that many are off by more than a quarter */
}

static void codes_follow_the_configuration(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = session(&said);
    WrImage *light = rendered(s, "render light.exr size=53x41", "light.exr");
    must_run(s, "tone view=Odd ocio=own.ocio");
    WrImage *codes = rendered(s, "render codes.png size=53x41", "codes.png");
    check_codes(codes, light, 1);
    wr_image_free(codes);
    must_run(s, "tone exposure=-1.5 view=Odd display=screen ocio=own.ocio space=half");
    codes = rendered(s, "render half.png size=53x41", "half.png");
    check_codes(codes, light, exp2(-1.5) / 2);
    wr_image_free(codes);
    wr_image_free(light);
    wr_session_free(s);
}

static void same_bytes(const char *a, const char *b, bool same)
{
    char command[200];
    snprintf(command, sizeof command, "cmp -s %s %s", a, b);
    assert_int_equal(system(command) == 0, same);
}

static void maps_and_light_are_untouched(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = session(&said);
    must_run(s, "render plain.png size=37x29");
    for (int i = 0; i < 2; i++) {
        char line[100];
        static const char *const outputs[] = { "export height h%d.png",
                                               "export normal+y n%d.png depth=8",
                                               "export occlusion o%d.png",
                                               "render l%d.exr size=37x29" };
        for (int k = 0; k < 4; k++) {
            snprintf(line, sizeof line, outputs[k], i);
            must_run(s, line);
        }
        must_run(s, "tone view=Odd ocio=own.ocio");
    }
    same_bytes("h0.png", "h1.png", true);
    same_bytes("n0.png", "n1.png", true);
    same_bytes("o0.png", "o1.png", true);
    WrError err;
    WrImage *a = wr_image_read("l0.exr", &err), *b = wr_image_read("l1.exr", &err);
    assert_memory_equal(a->data, b->data, sizeof(float) * 4 * 37 * 29);
    wr_image_free(a);
    wr_image_free(b);
    must_run(s, "render view.png size=37x29");
    same_bytes("plain.png", "view.png", false);
    must_run(s, "tone view=off");
    must_run(s, "render off.png size=37x29");
    same_bytes("plain.png", "off.png", true);
    wr_session_free(s);
}

static void errors_list_what_there_is(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = session(&said);
    unsetenv("OCIO");
    must_fail(s, "tone view=Odd", "set $OCIO, or add ocio=FILE");
    must_fail(s, "tone view=Odd ocio=none.ocio", "none.ocio: no such file: correct ocio=");
    must_fail(s, "tone view=Filmic ocio=own.ocio", "has no view 'Filmic', but Odd, As it is");
    must_fail(s, "tone view=Odd display=tv ocio=own.ocio", "has no display 'tv', but screen, wall");
    must_fail(s, "tone view=Odd display=wall ocio=own.ocio", "has no view 'Odd', but As it is");
    must_fail(s, "tone view=Odd space=red ocio=own.ocio", "no colour space 'red', but light, half");
    must_fail(s, "tone soft display=wall", "display= needs view=NAME");
    FILE *file = fopen("bad.ocio", "w");
    fputs("no configuration", file);
    fclose(file);
    must_fail(s, "tone view=Odd ocio=bad.ocio", "is no colour configuration");
    setenv("OCIO", "own.ocio", 1);
    must_run(s, "tone view=Odd");
    unsetenv("OCIO");
    wr_session_free(s);
}

static WrSession *opened(const char *path, Said *said)
{
    WrError err;
    WrSession *s = listening(said);
    if (!wr_session_open(s, path, &err)) fail_msg("%s", err.text);
    return s;
}

/* Documents and scripts open no configuration but the user's own; the names are kept in any case. */
static void opened_files_keep_names(void **state)
{
    (void)state;
    Said said = { "" };
    WrError err;
    WrSession *s = session(&said);
    must_run(s, "render plain.png size=37x29");
    must_run(s, "tone view=Odd ocio=own.ocio");
    must_run(s, "render view.png size=37x29");
    if (!wr_session_save(s, "kept.exr", &err)) fail_msg("%s", err.text);
    const WrHash hash = wr_session_hash(s);
    wr_session_free(s);
    FILE *file = fopen("stranger.wrinkle", "w");
    fputs("table 16x16\ntone view=Odd ocio=own.ocio\n", file);
    fclose(file);
    wr_session_free(opened("stranger.wrinkle", &said));
    assert_non_null(strstr(said.text, "view Odd is not shown"));
    s = opened("kept.exr", &said);
    assert_non_null(strstr(said.text, "view Odd is not shown"));
    assert_true(wr_hash_equal(hash, wr_session_hash(s)));
    must_run(s, "render again.png size=37x29");
    same_bytes("plain.png", "again.png", true);
    wr_session_free(s);
    char *path = realpath("own.ocio", NULL);
    setenv("OCIO", path, 1);
    said.text[0] = '\0';
    s = opened("kept.exr", &said);
    assert_null(strstr(said.text, "is not shown"));
    must_run(s, "render again.png size=37x29");
    same_bytes("view.png", "again.png", true);
    unsetenv("OCIO");
    free(path);
    wr_session_free(s);
}

static int enter(void **state)
{
    if (enter_folder(state) != 0) return -1;
    write_config("own.ocio");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_follow_the_configuration),
        cmocka_unit_test(maps_and_light_are_untouched),
        cmocka_unit_test(errors_list_what_there_is),
        cmocka_unit_test(opened_files_keep_names),
    };
    return cmocka_run_group_tests(tests, enter, remove_folder);
}
