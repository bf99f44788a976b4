/* The command normalmap: inputs, notes, changes and refusals; storage in documents; the map exported by the program
   bends normals like its table. */
#include "test.h"
#include "recovery_help.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/normal_map.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <math.h>
#include <unistd.h>

static const WrNormalMap *map_of(const WrSession *session)
{
    return &doc(session)->scene->normals;
}

static WrSession *told_session(Said *said)
{
    WrSessionOptions options = { .note = hear_note, .note_ctx = said, .outputs = true };
    return wr_session_new(&options);
}

/* Codes of f = sin(3 u + 2 v) and similar, with `bits` bits; centre: of 8 bits, 128 and 255 round it; down: green
   direction. */
static void write_map(const char *path, int bits, bool down, bool flat, double power)
{
    enum { W = 24, H = 17 };
    uint8_t bytes[W * H * 3];
    uint16_t words[W * H * 3];
    float floats[W * H * 3];
    WrError err = { "" };
    for (int t = 0; t < W * H; t++) {
        const double u = (t % W + 0.5) / W, v = 1 - (t / W + 0.5) / H, a = 6.283185307179586;
        const double s = flat ? 0 : (power == 1 ? 0.5 : 0.05) * cos(a * (3 * u + 2 * v)), p = 3 * s,
                     q = 2 * s;
        const double length = sqrt(1 + p * p + q * q), sign = down ? 1 : -1;
        const double n[3] = { -p / length, sign * q / length, 1 / length };
        for (int c = 0; c < 3; c++) {
            const double x = pow(n[c] / 2 + 0.5, power);
            bytes[3 * t + c] = (uint8_t)(255 * x + 0.5),
                          words[3 * t + c] = (uint16_t)(65535 * x + 0.5);
            floats[3 * t + c] = (float)n[c];
        }
    }
    const void *data = bits == 8 ? (void *)bytes : bits == 16 ? (void *)words : (void *)floats;
    const WrPixelType type = bits == 8 ? WR_PIXEL_U8 : bits == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
    if (!wr_image_write_pixels(path, W, H, 3, type, true, data, &err)) fail_msg("%s", err.text);
}

static void expect_told(Said *said, const char *words)
{
    if (!strstr(said->text, words)) fail_msg("'%s' is not told: %s", words, said->text);
    said->text[0] = '\0';
}

/* ---- reading, notes ---- */

static void what_was_taken_is_told(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = told_session(&said);
    write_map("up.png", 8, false, false, 1), write_map("down.tif", 16, true, false, 1);
    write_map("floats.exr", 32, true, false, 1), write_map("flat.png", 8, false, true, 1);
    write_map("bent.png", 8, false, false, 1 / 2.2);
    must_run(s, "normalmap up.png");
    expect_told(&said, "24x17, 3 channels of 8 bits; green up, found from its slopes");
    assert_true(map_of(s)->channels == 3 && !map_of(s)->green_down && map_of(s)->strength == 1);
    must_run(s, "normalmap down.tif channels=2 repeat=once");
    expect_told(&said, "2 channels of 16 bits, z rebuilt; green down, found from its slopes");
    assert_true(map_of(s)->green_down && map_of(s)->laid.own && map_of(s)->laid.ru == 1);
    must_run(s, "normalmap floats.exr");
    expect_told(&said, "floats, the vectors' own (coding=signed); green down, found");
    assert_false(map_of(s)->laid.own); /* settings of another file are not kept */
    must_run(s, "normalmap flat.png");
    expect_told(&said, "code 128 stands for 0; green up, undecided");
    must_run(s, "normalmap bent.png green=up");
    expect_told(&said, "sRGB");
    must_run(s, "normalmap floats.exr space=object");
    assert_true(map_of(s)->object && map_of(s)->image->data[2] > 0);
    wr_session_free(s);
}

static void settings_change_without_the_file(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = told_session(&said);
    write_map("up.png", 8, false, false, 1);
    must_run(s, "normalmap up.png strength=0.5");
    const WrImage *image = map_of(s)->image;
    const float y = image->data[1];
    must_fail(s, "colour repeat=once", "no colour picture");
    must_run(s, "colour up.png");
    must_run(s, "colour repeat=once"); /* also not kept */
    assert_true(doc(s)->scene->colour_laid.own && doc(s)->scene->colour);
    must_run(s, "undo");
    assert_false(doc(s)->scene->colour_laid.own);
    must_run(s, "undo");
    assert_int_equal(unlink("up.png"), 0);
    must_run(s, "normalmap strength=2 repeat=2,-0.5");
    assert_true(map_of(s)->strength == 2 && map_of(s)->laid.rv == -0.5 &&
                map_of(s)->image == image);
    must_run(s, "normalmap combine=surface");
    assert_true(map_of(s)->combine == WR_COMBINE_SURFACE && map_of(s)->strength == 2);
    must_run(s, "undo");
    assert_true(map_of(s)->combine == WR_COMBINE_SLOPES);
    must_run(s, "normalmap green=down");
    assert_true(map_of(s)->green_down && map_of(s)->image->data[1] == -y);
    must_run(s, "undo");
    assert_true(!map_of(s)->green_down && map_of(s)->image->data[1] == y);
    must_run(s, "undo 2");
    assert_null(map_of(s)->image);
    must_run(s, "redo 3");
    must_run(s, "normalmap none");
    assert_null(map_of(s)->image);
    must_run(s, "undo"), must_run(s, "normalmap off");
    assert_null(map_of(s)->image);
    wr_session_free(s);
}

/* Converting to the object's axes changes nothing; converting back moves vectors that face away to the horizon and
   counts them. */
static void the_space_changes_without_the_file(void **state)
{
    (void)state;
    Said said = { "" };
    WrError err = { "" };
    WrSession *s = told_session(&said);
    const float n[6] = { 0.6F, 0, -0.8F, 0.48F, 0.6F, 0.64F };
    assert_true(wr_image_write_pixels("two.exr", 2, 1, 3, WR_PIXEL_F32, true, n, &err));
    must_run(s, "normalmap two.exr space=object green=up");
    assert_int_equal(unlink("two.exr"), 0);
    must_run(s, "normalmap space=tangent");
    expect_told(&said, "1 normals that point below the surface");
    const float *made = map_of(s)->image->data;
    assert_near(made[0], 1, 1e-5);
    assert_near(made[2], WR_NORMAL_MIN / hypot(0.6, WR_NORMAL_MIN), 1e-6);
    for (int c = 0; c < 3; c++) assert_near(made[3 + c], n[3 + c], 1e-6);
    assert_false(map_of(s)->object);
    const WrHash tangent = wr_session_hash(s);
    must_run(s, "normalmap space=object strength=0.5");
    assert_true(map_of(s)->object && map_of(s)->strength == 0.5);
    must_run(s, "undo");
    assert_true(wr_hash_equal(wr_session_hash(s), tangent));
    must_run(s, "undo");
    assert_near(map_of(s)->image->data[2], -0.8, 1e-6);
    must_fail(s, "normalmap space=object channels=2", "needs a file");
    wr_session_free(s);
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = told_session(&said);
    const uint8_t grey[4] = { 1, 2, 3, 4 };
    WrError err = { "" };
    write_map("up.png", 8, false, false, 1);
    assert_true(wr_image_write_pixels("grey.png", 2, 2, 1, WR_PIXEL_U8, false, grey, &err));
    must_fail(s, "normalmap strength=2", "no normal map");
    must_fail(s, "normalmap nothing.png", "nothing.png");
    must_fail(s, "normalmap grey.png", "2 or 3");
    must_fail(s, "normalmap grey.png space=object", "must be 3");
    must_fail(s, "normalmap up.png space=object channels=2", "channels=");
    must_fail(s, "normalmap up.png strength=101", "-100..100");
    must_fail(s, "normalmap off strength=1", "strength= cannot be given with off");
    must_run(s, "normalmap up.png");
    must_fail(s, "normalmap channels=2", "needs a file");
    must_fail(s, "normalmap green=auto", "needs a file");
    must_fail(s, "normalmap repeat=1", "repeat");
    wr_session_free(s);
}

/* ---- storage in files ---- */

static void draw(WrSession *session, float *out)
{
    WrFrame frame;
    WrError err = { "" };
    if (!wr_session_frame(session, 60, 40, 20, &frame, &err)) fail_msg("%s", err.text);
    memcpy(out, frame.rgba, 60 * 40 * 4 * sizeof *out);
}

/* Maps of 8 and 16 bits and of floats on separate objects, one beside a colour picture, are restored bit for bit from
   a document, an OpenRaster file and a script. The picture files are deleted before, except for the script. */
static void files_bring_them_back(void **state)
{
    (void)state;
    static const char *const names[] = { "./n.exr", "./n.ora", "./n.wrinkle" };
    Said said = { "" };
    WrError err = { "" };
    WrSession *a = told_session(&said);
    write_map("8.png", 8, false, false, 1), write_map("16.tif", 16, true, false, 1);
    write_map("f.exr", 32, false, false, 1);
    must_run(a, "normalmap 8.png strength=1.5");
    must_run(a, "object add two at=1.5,0,0");
    must_run(a, "surface sphere");
    must_run(a, "normalmap 16.tif repeat=3,2");
    must_run(a, "colour 8.png");
    must_run(a, "object add three at=0,1.5,0");
    must_run(a, "normalmap f.exr channels=2 strength=-0.5 combine=reoriented");
    must_run(a, "object add four at=1.5,1.5,0");
    must_run(a, "surface torus");
    must_run(a, "normalmap f.exr space=object");
    static float before[60 * 40 * 4], after[60 * 40 * 4];
    draw(a, before);
    for (int i = 0; i < 3; i++) {
        const bool good =
            i < 2 ? wr_session_save(a, names[i], &err) : wr_session_save_history(a, names[i], &err);
        if (!good) fail_msg("%s", err.text);
    }
    for (int i = 2; i >= 0; i--) {
        WrSession *b = told_session(&said);
        if (!wr_session_open(b, names[i], &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        draw(b, after);
        assert_memory_equal(before, after, sizeof before);
        for (int k = 0; k < 4; k++) {
            const WrNormalMap *x = &wr_scene_object(doc(a)->scene, k)->normals;
            const WrNormalMap *y = &wr_scene_object(doc(b)->scene, k)->normals;
            assert_memory_equal(x->image->data, y->image->data, 24 * 17 * 3 * sizeof(float));
            assert_true(x->strength == y->strength && x->channels == y->channels);
            assert_true(x->green_down == y->green_down && x->object == y->object);
            assert_true(x->combine == y->combine &&
                        x->combine == (k == 2 ? WR_COMBINE_REORIENTED : WR_COMBINE_SLOPES));
        }
        must_run(b, "object choose two");
        must_run(b, "normalmap green=up"); /* of a map without a file */
        wr_session_free(b);
        if (i == 2) assert_int_equal(unlink("8.png") | unlink("16.tif") | unlink("f.exr"), 0);
    }
    wr_session_free(a);
}

/* Crash recovery: the map is restored without its file; `off` is not a file, even if one has that name. */
static void maps_are_recovered_without_their_files(void **state)
{
    (void)state;
    WrError err = { "" };
    WrRecovered how;
    write_map("up.png", 8, false, false, 1), write_map("down.tif", 16, true, false, 1);
    if (!wr_file_write("off", "x", 1, &err) || !wr_file_write("none", "x", 1, &err))
        fail_msg("%s", err.text);
    WrSessionOptions options = { .journal = true };
    WrSession *s = wr_session_new(&options);
    must_run(s, "colour up.png");
    must_run(s, "normalmap down.tif channels=2");
    must_run(s, "colour off");
    must_run(s, "normalmap none");
    must_run(s, "normalmap up.png strength=0.5");
    must_run(s, "normalmap green=down repeat=once");
    const WrHash want = wr_session_hash(s);
    wr_session_journal_leave(s);
    wr_session_free(s);
    assert_int_equal(unlink("up.png") | unlink("down.tif"), 0);
    char *journal = only_journal();
    s = wr_session_new(&options);
    if (!wr_session_recover(s, journal, false, &how, &err)) fail_msg("%s", err.text);
    if (!how.whole) fail_msg("%s", wr_text_get(&how.report));
    assert_true(wr_hash_equal(want, wr_session_hash(s)));
    assert_true(map_of(s)->strength == 0.5 && map_of(s)->green_down && !doc(s)->scene->colour);
    wr_recovered_fini(&how);
    wr_session_free(s);
    wr_free(journal);
}

/* ---- our own export ---- */

static void write_ball(const char *path)
{
    enum { U = 24, V = 12 };
    WrText text = { 0 };
    WrError err = { "" };
    for (int i = 0; i <= U; i++)
        for (int j = 0; j <= V; j++) {
            const double a = 6.283185307179586 * (i % U) / U,
                         l = 3.141592653589793 * (j - V / 2.0) / V;
            const double x = cos(a) * cos(l), y = sin(a) * cos(l), z = sin(l);
            wr_text_addf(&text, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\nvt %.9g %.9g\n", x, y, z, x,
                         y, z, (double)i / U, (double)j / V);
        }
    for (int i = 0; i < U; i++)
        for (int j = 0; j < V; j++) {
            const int a = i * (V + 1) + j + 1, b = a + V + 1;
            wr_text_addf(&text, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, b + 1, b + 1,
                         b + 1);
            wr_text_addf(&text, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b + 1, b + 1, b + 1,
                         a + 1, a + 1, a + 1);
        }
    if (!wr_file_write(path, text.data, text.length, &err)) fail_msg("%s", err.text);
    wr_text_fini(&text);
}

/* The picture with the table's bump against that with its exported map on a flat table: equal within the angular
   precision of the format. */
static void an_exported_map_gives_the_bumped_picture(void **state)
{
    (void)state;
    static const char *const objects[] = { "surface plane", "surface sphere", "surface torus",
                                           "surface mesh", "surface mesh file=ball.obj" };
    static const struct {
        const char *file;
        double within;
    } files[] = { { "n.png depth=8", 0.09 }, { "n.png depth=16", 6e-4 }, { "n.exr", 1e-4 } };
    static float bumped[60 * 40 * 4], mapped[60 * 40 * 4];
    write_ball("ball.obj");
    for (int k = 0; k < 30; k++) {
        Said said = { "" };
        char line[128];
        const bool down = k / 3 % 2;
        WrSession *s = told_session(&said);
        must_run(s, "table 61x46");
        must_run(s, "formula fourier terms=3,2,0.5,0,0;0,5,0.3,0,0");
        must_run(s, objects[k / 6]);
        said.text[0] = '\0';
        must_run(s, "bump height=0.02");
        must_run(s, k / 6 == 3 ? "replicate 1,1" : "replicate 2,1"); /* frames are not reduced */
        draw(s, bumped);
        snprintf(line, sizeof line, "export normal%cy %s", down ? '-' : '+', files[k % 3].file);
        must_run(s, line);
        must_run(s, "fill 0.3");
        snprintf(line, sizeof line, "normalmap %s", k % 3 == 2 ? "n.exr" : "n.png");
        must_run(s, line);
        expect_told(&said, down ? "green down, as its label says" : "green up, as its label says");
        if (k / 24) must_run(s, "normalmap frame=gradient"); /* the square has unit (u,v) */
        /* affects the flat table, not the map */
        must_run(s, "bump height=0.9");
        draw(s, mapped);
        double worst = 0;
        for (int i = 0; i < 60 * 40 * 4; i++)
            worst = fmax(worst, fabs((double)(bumped[i] - mapped[i])));
        if (getenv("WR_SHOW")) printf("%s %s: %g\n", objects[k / 6], files[k % 3].file, worst);
        if (!(worst < files[k % 3].within)) fail_msg("case %d: %g", k, worst);
        wr_session_free(s);
    }
}

/* A map along the object's axes includes the surface and any bump mode. */
static void a_map_along_the_axes_gives_the_bumped_picture(void **state)
{
    (void)state;
    static float bumped[60 * 40 * 4], mapped[60 * 40 * 4];
    static const char *const scenes[] = { "surface sphere", "surface torus R=1 r=0.4",
                                          "surface plane" };
    static const char *const modes[] = { "blinn", "exact", "invariant" };
    for (int k = 0; k < 9; k++) {
        char line[100];
        Said said = { "" };
        WrSession *s = told_session(&said);
        must_run(s, "table 256x256");
        must_run(s, "solid sphere at=0.4,0.55 radius=60"), must_run(s, "adjust blur sigma=6");
        must_run(s, scenes[k / 3]);
        snprintf(line, sizeof line, "bump mode=%s scheme=bspline height=0.02", modes[k % 3]);
        must_run(s, line);
        draw(s, bumped);
        must_run(s, k % 2 ? "export normal-object n.png" : "export normal-object n.exr");
        must_run(s, "fill 0");
        must_run(s, "bump mode=blinn");
        must_run(s, k % 2 ? "normalmap n.png space=object" : "normalmap n.exr space=object");
        draw(s, mapped);
        double worst = 0;
        for (int i = 0; i < 60 * 40 * 4; i++)
            worst = fmax(worst, fabs((double)(bumped[i] - mapped[i])));
        if (getenv("WR_SHOW")) printf("%s %s: %g\n", scenes[k / 3], modes[k % 3], worst);
        if (!(worst < 6e-4)) fail_msg("case %d: %g", k, worst);
        wr_session_free(s);
    }
}

/* With so many numbers, some are half way between two codes as exactly as floats allow. */
static void numbers_between_two_codes_are_written_too(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = told_session(&said);
    must_run(s, "table 300x300");
    must_run(s, "noise gradient cells=8 octaves=6");
    must_run(s, "surface mesh");
    must_run(s, "export normal-baked half.png");
    wr_session_free(s);
}

/* The object's normal map and bump painted over it leave as one map. */
static void a_baked_map_holds_the_normal_map_too(void **state)
{
    (void)state;
    static float both[60 * 40 * 4], one[60 * 40 * 4], bump[60 * 40 * 4], added[60 * 40 * 4];
    static const char *const frames[] = { "mikk", "lecture", "gradient", "mikk", "mikk" };
    write_ball("ball.obj");
    for (int k = 0; k < 5; k += test_amount(1, 2)) {
        const int combine = k < 3 ? 0 : k - 2;
        Said said = { "" };
        WrText line = { 0 };
        WrSession *s = told_session(&said);
        must_run(s, "table 512x512");
        must_run(s, "formula fourier terms=3,2,0.5,0,0");
        must_run(s, "surface mesh file=ball.obj");
        must_run(s, combine ? "bump height=0.2 scheme=bspline" : "bump height=0.02 scheme=bspline");
        must_run(s, "export normal-baked first.exr");
        wr_text_addf(&line, "normalmap first.exr frame=%s strength=0.7 combine=%s", frames[k],
                     wr_combine_names[combine]);
        must_run(s, wr_text_get(&line));
        must_run(s, "formula fourier terms=0,5,0.3,0,0 blend=replace");
        draw(s, both);
        must_run(s, "export normal-baked both.exr");
        must_run(s, "normalmap combine=slopes");
        draw(s, added);
        must_run(s, "normalmap off");
        draw(s, bump);
        must_run(s, "fill 0");
        must_run(s, "normalmap both.exr frame=mikk");
        draw(s, one);
        double sum = 0, map = 0, sums = 0;
        for (int i = 0; i < 60 * 40 * 4; i++) {
            sum += pow((double)(both[i] - one[i]), 2), map += pow((double)(both[i] - bump[i]), 2);
            sums += pow((double)(both[i] - added[i]), 2);
        }
        const double rms = sqrt(sum / (60 * 40 * 4)), rms_map = sqrt(map / (60 * 40 * 4));
        const double rms_added = sqrt(sums / (60 * 40 * 4));
        if (getenv("WR_SHOW"))
            printf("%s: rms %g, of the map %g, added %g\n", wr_text_get(&line), rms, rms_map,
                   rms_added);
        if (!(rms < (combine ? 2e-3 : 6e-4) && rms_map > 4 * rms))
            fail_msg("%s: rms %g, of the map %g", wr_text_get(&line), rms, rms_map);
        if (combine ? !(rms_added > 2 * rms) : rms_added != 0)
            fail_msg("%s: rms %g, added %g", wr_text_get(&line), rms, rms_added);
        wr_text_fini(&line);
        wr_session_free(s);
    }
}

/* On a mesh, by MikkTSpace: shaded with those frames it equals the bumped picture. */
static void a_baked_map_gives_the_bumped_picture(void **state)
{
    (void)state;
    static float bumped[60 * 40 * 4], mapped[60 * 40 * 4];
    static const char *const meshes[] = { "surface mesh", "surface mesh file=ball.obj" };
    write_ball("ball.obj");
    for (int k = 0; k < 4; k++) {
        Said said = { "" };
        WrSession *s = told_session(&said);
        must_run(s, "table 512x512");
        must_run(s, "formula fourier terms=3,2,0.5,0,0;0,5,0.3,0,0");
        must_run(s, meshes[k / 2]);
        must_run(s, "bump height=0.02 scheme=bspline");
        draw(s, bumped);
        must_run(s, k % 2 ? "export normal-baked b.png axes=directx" : "export normal-baked b.exr");
        must_run(s, "fill 0");
        said.text[0] = '\0';
        must_run(s, k % 2 ? "normalmap b.png frame=mikk" : "normalmap b.exr frame=mikk");
        expect_told(&said, k % 2 ? "green down, as its label says" : "green up, as its label says");
        draw(s, mapped);
        double worst = 0, sum = 0;
        for (int i = 0; i < 60 * 40 * 4; i++) {
            const double off = fabs((double)(bumped[i] - mapped[i]));
            worst = fmax(worst, off), sum += off * off;
        }
        const double rms = sqrt(sum / (60 * 40 * 4));
        if (getenv("WR_SHOW")) printf("baked %s: %g, rms %g\n", meshes[k / 2], worst, rms);
        /* Slopes jump at the sphere's edges, which the map's texels blur. */
        if (!(worst < (k / 2 ? 0.03 : 6e-4) && rms < (k / 2 ? 6e-4 : 2e-4)))
            fail_msg("case %d: %g, rms %g", k, worst, rms);
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_taken_is_told),
        cmocka_unit_test(numbers_between_two_codes_are_written_too),
        cmocka_unit_test(settings_change_without_the_file),
        cmocka_unit_test(the_space_changes_without_the_file),
        cmocka_unit_test(what_makes_no_sense_is_refused),
        cmocka_unit_test(files_bring_them_back),
        cmocka_unit_test(maps_are_recovered_without_their_files),
        cmocka_unit_test(an_exported_map_gives_the_bumped_picture),
        cmocka_unit_test(a_map_along_the_axes_gives_the_bumped_picture),
        cmocka_unit_test(a_baked_map_gives_the_bumped_picture),
        cmocka_unit_test(a_baked_map_holds_the_normal_map_too),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}
