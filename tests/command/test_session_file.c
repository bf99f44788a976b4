/* Sessions and files: scripts, pictures, documents, colour pictures, outputs. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <sys/stat.h>
#include <unistd.h>

typedef struct Notes {
    WrText text;
} Notes;

static void keep_note(void *ctx, const char *text)
{
    wr_text_addf(&((Notes *)ctx)->text, "%s\n", text);
}

static WrSession *new_session(Notes *notes, bool outputs)
{
    WrSessionOptions options = { .note = keep_note, .note_ctx = notes, .outputs = outputs };
    return wr_session_new(&options);
}

static void write_text(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static const WrField *field_of(const WrSession *session)
{
    return wr_document_field(wr_session_document(session));
}

/* ---- scripts ---- */

static void script_errors_carry_file_and_line(void **state)
{
    (void)state;
    const struct {
        const char *text, *error;
    } bad[] = { { "fill 1\n\n# x\nfil 2\n", "a.wrinkle:4: unknown command" },
                { "dab 0,0 radius=-1", "a.wrinkle:1: dab: radius=-1" },
                { "fill 1\r\nfill\r\n", "a.wrinkle:2: fill: F" },
                { "image nosuch.png", "a.wrinkle:1: image: nosuch.png: No such file" } };
    Notes notes = { 0 };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrError err = { "" };
        write_text("a.wrinkle", bad[i].text);
        WrSession *s = new_session(&notes, true);
        assert_false(wr_session_run_script(s, "a.wrinkle", &err));
        if (strncmp(err.text, bad[i].error, strlen(bad[i].error)) != 0)
            fail_msg("%s\n  is not  %s", err.text, bad[i].error);
        wr_session_free(s);
    }
    wr_text_fini(&notes.text);
}

static void a_script_with_mark_and_crlf_runs_and_one_with_nul_does_not(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, true);
    write_text("a.wrinkle", "\xEF\xBB\xBFtable 8x8\r\nfill 2\r\n\r\n  # end");
    assert_true(wr_session_run_script(s, "a.wrinkle", &err));
    assert_true(wr_field_get(field_of(s), 7, 7) == 2);
    assert_true(wr_file_write("b.wrinkle", "fill 3\nfill\0 4\n", 15, &err));
    assert_false(wr_session_run_script(s, "b.wrinkle", &err));
    assert_non_null(strstr(err.text, "b.wrinkle:2: "));
    assert_true(wr_field_get(field_of(s), 7, 7) == 3); /* the effect of earlier lines stays */
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void opening_a_script_writes_nothing_and_says_so(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, true);
    write_text("a.wrinkle", "fill 2\nsave x.exr\nrender y.png\nexport height z.png\n");
    assert_true(wr_session_open(s, "a.wrinkle", &err));
    assert_false(exists("x.exr") || exists("y.png") || exists("z.png"));
    int lines = 0;
    for (const char *p = wr_text_get(&notes.text); *p; p++) lines += *p == '\n';
    assert_int_equal(lines, 3);
    assert_true(wr_session_revision(s) == wr_session_saved_revision(s));
    assert_string_equal(wr_session_path(s), "");
    assert_true(wr_session_run_script(s, "a.wrinkle", &err));
    assert_true(exists("x.exr") && exists("y.png") && exists("z.png"));
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void open_keeps_what_it_had_when_it_fails(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, false);
    must_run(s, "dab 0.5,0.5");
    WrHash before = wr_session_hash(s);
    write_text("bad.wrinkle", "fill 5\ntable 0x0\n");
    write_text("bad.png", "\x89PNG\r\n\x1a\nnot really");
    write_text("bad.exr", "\x76\x2f\x31\x01 not really");
    const char *names[] = { "bad.wrinkle", "bad.png", "bad.exr", "none.wrinkle", "none.exr", "." };
    for (int i = 0; i < 6; i++) {
        assert_false(wr_session_open(s, names[i], &err));
        assert_true(strncmp(err.text, names[i], strlen(names[i])) == 0);
        assert_true(wr_hash_equal(before, wr_session_hash(s)));
        assert_string_equal(wr_session_last_command(s), "dab 0.5,0.5");
        assert_true(wr_session_revision(s) == 1 && wr_session_saved_revision(s) == 0);
    }
    assert_false(wr_session_open(s, "none.exr", &err));
    assert_string_equal(err.text, "none.exr: No such file or directory");
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

/* ---- pictures ---- */

static void write_grey(const char *path, int width, int height, const uint8_t *codes)
{
    WrError err;
    if (!wr_image_write_pixels(path, width, height, 1, WR_PIXEL_U8, true, codes, &err))
        fail_msg("%s", err.text);
}

static void image_gives_the_table_the_pictures_size_and_codes(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    const uint8_t codes[6] = { 0, 51, 102, 153, 204, 255 };
    char hex[65], expected[200];
    write_grey("g.png", 3, 2, codes);
    WrSession *s = new_session(&notes, false);
    must_run(s, "table 9x9 wrap=clamp");
    must_run(s, "image g.png");
    assert_int_equal(wr_field_width(field_of(s)), 3);
    assert_int_equal(wr_field_wrap_u(field_of(s)), WR_WRAP_CLAMP);
    for (int k = 0; k < 6; k++)
        assert_near(wr_field_get(field_of(s), k % 3, k / 3), codes[k] / 255.0, 1e-7);
    assert_true(wr_sha256_file("g.png", hex, &err));
    snprintf(expected, sizeof expected, "image g.png sha256=%s", hex);
    assert_string_equal(wr_session_last_command(s), expected);
    must_run(s, expected);
    must_run(s, "table 8x5");
    must_run(s, "image g.png fit=table");
    assert_int_equal(wr_field_width(field_of(s)), 8);
    assert_int_equal(wr_field_height(field_of(s)), 5);
    char *last = expected + strlen(expected) - 1;
    *last = *last == '0' ? '1' : '0'; /* another digit */
    WrHash before = wr_session_hash(s);
    assert_false(wr_session_run(s, expected, &err));
    assert_non_null(strstr(err.text, hex));
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void hc49_values_that_are_not_finite_are_counted_in_a_note(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    const float values[4] = { 1, NAN, INFINITY, -2 };
    assert_true(wr_image_write_pixels("n.exr", 2, 2, 1, WR_PIXEL_F32, true, values, &err));
    WrSession *s = new_session(&notes, false);
    assert_true(wr_session_open(s, "n.exr", &err));
    assert_non_null(strstr(wr_text_get(&notes.text), "2 values were not finite"));
    assert_true(wr_field_get(field_of(s), 1, 0) == 0 && wr_field_get(field_of(s), 1, 1) == -2);
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void a_script_reads_beside_itself_and_writes_here(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    const uint8_t codes[1] = { 255 };
    assert_int_equal(mkdir("sub", 0777), 0);
    write_grey("sub/g.png", 1, 1, codes);
    write_text("sub/a.wrinkle", "image g.png\nsave out.exr\n");
    WrSession *s = new_session(&notes, true);
    if (!wr_session_run_script(s, "sub/a.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(exists("out.exr") && !exists("sub/out.exr"));
    assert_true(wr_field_get(field_of(s), 0, 0) == 1);
    assert_false(wr_session_run(s, "image g.png", &err)); /* no script is running */
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

/* ---- documents ---- */

static void save_and_open_give_the_same_document(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *a = new_session(&notes, true), *b = new_session(&notes, false);
    const char *lines[] = { "table 100x70 wrap=clamp-u",   "grid cells=5x3",
                            "dab 0.2,0.9 radius=30",       "surface torus R=2",
                            "bump mode=exact height=0.01", "rotate 1,2,3",
                            "light point at=0,0,9",        "analytic fourier terms=1,1,1,30,60",
                            "camera orthographic size=3",  "dials aa=supersample" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(a, lines[i]);
    assert_true(wr_session_saved_revision(a) != wr_session_revision(a));
    must_run(a, "save d.exr");
    assert_true(wr_session_saved_revision(a) == wr_session_revision(a));
    assert_string_equal(wr_session_path(a), "d.exr");
    assert_int_equal(wr_session_history_count(a), 8); /* without views and save */
    if (!wr_session_open(b, "d.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    assert_string_equal(wr_session_path(b), "d.exr");
    assert_true(wr_session_saved_revision(b) == wr_session_revision(b));
    assert_int_equal(wr_session_history_count(b), 0);
    must_run(b, "fill 1");
    assert_true(wr_session_saved_revision(b) != wr_session_revision(b));
    wr_session_free(a);
    wr_session_free(b);
    wr_text_fini(&notes.text);
}

static void a_document_carries_its_colour_picture(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    const uint8_t codes[8] = { 255, 0, 10, 128, 188, 11, 255, 255 }; /* RGBA, 2 x 1 */
    assert_true(wr_image_write_pixels("c.png", 2, 1, 4, WR_PIXEL_U8, false, codes, &err));
    WrSession *a = new_session(&notes, true), *b = new_session(&notes, false);
    must_run(a, "colour c.png");
    const WrImage *colour = wr_session_document(a)->scene->colour;
    assert_int_equal(colour->channels, 3);
    /* IEC 61966-2-1: code/12.92 up to 0.04045, else ((code + 0.055)/1.055)^2.4 */
    assert_true(colour->data[0] == 1 && colour->data[1] == 0);
    assert_near(colour->data[2], 10 / 255.0 / 12.92, 1e-7);
    assert_near(colour->data[3], pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
    must_run(a, "colour c.png repeat=2,-0.5");
    must_run(a, "save d.exr");
    assert_int_equal(unlink("c.png"), 0);
    if (!wr_session_open(b, "d.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    const WrImage *loaded = wr_session_document(b)->scene->colour;
    assert_int_equal(loaded->width, 2);
    const WrScene *scene = wr_session_document(b)->scene;
    assert_true(scene->colour_laid.own && scene->colour_laid.ru == 2 &&
                scene->colour_laid.rv == -0.5);
    assert_memory_equal(loaded->data, wr_session_document(a)->scene->colour->data,
                        6 * sizeof(float));
    must_run(b, "colour off");
    assert_null(wr_session_document(b)->scene->colour);
    wr_session_free(a);
    wr_session_free(b);
    wr_text_fini(&notes.text);
}

static void a_float_colour_picture_is_taken_as_linear(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    const float values[3] = { 0.25f, 2, -1 };
    assert_true(wr_image_write_pixels("c.exr", 1, 1, 3, WR_PIXEL_F32, false, values, &err));
    WrSession *s = new_session(&notes, false);
    must_run(s, "colour c.exr");
    const float *pixel = wr_session_document(s)->scene->colour->data;
    assert_true(pixel[0] == 0.25f && pixel[1] == 2 && pixel[2] == 0);
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

/* ---- outputs ---- */

static void outputs_are_skipped_with_one_note_each_unless_asked_for(void **state)
{
    (void)state;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, false);
    must_run(s, "save x.exr");
    must_run(s, "render \"y z.png\"");
    assert_string_equal(wr_text_get(&notes.text),
                        "skipped: save x.exr (only `wrinkle run` writes files)\n"
                        "skipped: render \"y z.png\" (only `wrinkle run` writes files)\n");
    assert_false(exists("x.exr") || exists("y z.png"));
    assert_true(wr_session_revision(s) == 0);
    wr_session_set_outputs(s, true);
    must_run(s, "save x.exr");
    assert_true(exists("x.exr"));
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void outputs_that_fail_leave_no_file(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, true);
    const char *bad[] = { "save nofolder/x.exr",
                          "save x.png",
                          "save .",
                          "render x.nosuch",
                          "render nofolder/x.png",
                          "export height x.nosuch",
                          "export height x.jpg depth=16" };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        err.text[0] = '\0';
        if (wr_session_run(s, bad[i], &err)) fail_msg("accepted: %s", bad[i]);
        assert_true(err.text[0] != '\0');
    }
    assert_int_equal(system("test -z \"$(ls -A)\""), 0);
    assert_string_equal(wr_session_path(s), "");
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void rendered_files_hold_linear_float_or_srgb_over_the_background(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = new_session(&notes, true);
    must_run(s, "light clear");
    must_run(s, "material ambient=0.5 colour=0.4,0.2,1");
    must_run(s, "render p.exr size=64x32");
    must_run(s, "render p.png size=64x32");
    WrImage *linear = wr_image_read("p.exr", &err), *codes = wr_image_read("p.png", &err);
    assert_non_null(linear);
    assert_non_null(codes);
    assert_int_equal(linear->channels, 4);
    assert_int_equal(codes->channels, 3);
    assert_int_equal(codes->type, WR_PIXEL_U8);
    /* No light: I = C ka on the plane in the middle, 0 in the corner. */
    const float *middle = linear->data + (size_t)(16 * 64 + 32) * 4;
    const float expected[4] = { 0.2f, 0.1f, 0.5f, 1 };
    for (int c = 0; c < 4; c++) {
        assert_near(middle[c], expected[c], 1e-6);
        assert_true(linear->data[c] == 0);
    }
    const double *background = wr_session_document(s)->scene->background.top;
    for (int c = 0; c < 3; c++) {
        assert_near(codes->data[(16 * 64 + 32) * 3 + c], wr_srgb_encode(expected[c]), 0.51 / 255);
        assert_near(codes->data[c], wr_srgb_encode((float)background[c]), 0.51 / 255);
    }
    wr_image_free(linear);
    wr_image_free(codes);
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void a_cancelled_script_stops_with_an_error(void **state)
{
    (void)state;
    WrError err;
    volatile int cancel = 1;
    const WrProgress progress = { .cancel = &cancel };
    WrSession *s = wr_session_new(NULL);
    write_text("a.wrinkle", "fill 1\n");
    wr_progress_set(&progress);
    assert_false(wr_session_run_script(s, "a.wrinkle", &err));
    wr_progress_set(NULL);
    assert_non_null(strstr(err.text, "cancelled"));
    assert_true(wr_session_revision(s) == 0);
    wr_session_free(s);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter_own_folder, leave_own_folder)

/* A document is checked before use: its scene lines can neither write nor open files. */
static void a_document_holds_no_commands_but_of_its_scene(void **state)
{
    (void)state;
    static const char *const lines[] = { "save stolen.exr",   "open /dev/zero",  "fill 3", "undo",
                                         "render stolen.png", "history budget=0" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrError err = { "" };
        WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
        const WrDocument *document = wr_session_document(session);
        if (!wr_document_save(document, lines[i], "hostile.exr", NULL, &err))
            fail_msg("%s", err.text);
        assert_false(wr_session_open(session, "hostile.exr", &err));
        if (!strstr(err.text, "is not a command of a scene"))
            fail_msg("%s: %s", lines[i], err.text);
        wr_session_free(session);
    }
    assert_int_not_equal(access("stolen.exr", F_OK), 0);
}

/* Text parameters of a surface are stored with its numbers: undo, documents, scene text. */
static void a_surfaces_texts_travel_with_the_document(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrText before = { 0 }, after = { 0 };
    WrSession *s = new_session(&notes, true), *other = new_session(&notes, true);
    must_run(s, "table 8x8");
    must_run(s, "surface revolution profile=0.5,-1;0.75,0;0.25,1");
    const uint64_t key = doc(s)->scene->shape.key;
    wr_session_scene_text(s, &before);
    assert_non_null(
        strstr(wr_text_get(&before), "surface revolution profile=\"0.5,-1;0.75,0;0.25,1\"\n"));
    must_fail(s, "surface revolution profile=1,0;-1,0", "point 2");
    must_run(s, "surface revolution");
    must_run(s, "surface sphere");
    must_run(s, "undo 2");
    assert_true(doc(s)->scene->shape.key == key);
    if (!wr_session_save(s, "a.exr", &err)) fail_msg("%s", err.text);
    must_run(other, "open a.exr");
    wr_session_scene_text(other, &after);
    assert_string_equal(wr_text_get(&before), wr_text_get(&after));
    assert_true(doc(other)->scene->shape.key == key);
    wr_session_free(s);
    wr_session_free(other);
    wr_text_fini(&before);
    wr_text_fini(&after);
    wr_text_fini(&notes.text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(a_surfaces_texts_travel_with_the_document),
        IN_FOLDER(script_errors_carry_file_and_line),
        IN_FOLDER(a_script_with_mark_and_crlf_runs_and_one_with_nul_does_not),
        IN_FOLDER(opening_a_script_writes_nothing_and_says_so),
        IN_FOLDER(open_keeps_what_it_had_when_it_fails),
        IN_FOLDER(image_gives_the_table_the_pictures_size_and_codes),
        IN_FOLDER(hc49_values_that_are_not_finite_are_counted_in_a_note),
        IN_FOLDER(a_script_reads_beside_itself_and_writes_here),
        IN_FOLDER(save_and_open_give_the_same_document),
        IN_FOLDER(a_document_carries_its_colour_picture),
        IN_FOLDER(a_float_colour_picture_is_taken_as_linear),
        IN_FOLDER(outputs_are_skipped_with_one_note_each_unless_asked_for),
        IN_FOLDER(outputs_that_fail_leave_no_file),
        IN_FOLDER(rendered_files_hold_linear_float_or_srgb_over_the_background),
        IN_FOLDER(a_cancelled_script_stops_with_an_error),
        IN_FOLDER(a_document_holds_no_commands_but_of_its_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
