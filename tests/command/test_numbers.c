/* test_numbers.c - heights as raw numbers with a sidecar: exact bytes in both orders, reading by every command;
   sidecars of other programs; half-float EXR. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

enum { W = 45, H = 62 };

static WrSession *rough_table(Said *said)
{
    WrSession *s = listening(said);
    must_run(s, "table 45x62 wrap=clamp-v");
    must_run(s, "noise perlin cells=3 octaves=4 amplitude=2.3 level=-1.1 seed=5");
    must_run(s, "cell 90,62 mm=on height=3.5");
    return s;
}

static size_t read_bytes(const char *path, unsigned char *bytes, size_t most)
{
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s is missing", path);
    const size_t count = fread(bytes, 1, most, file);
    fclose(file);
    return count;
}

/* ---- writing ---- */

static void bytes_are_the_codes_in_either_order(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "export height h.raw range=-4,3", "export height h.raw range=-4,3 endian=big",
        "export height h.r16 range=-4,3", "export height h.r32",
        "export height h.r32 endian=big", "export height h.raw depth=32 endian=little",
    };
    for (int k = 0; k < 6; k++) {
        Said said;
        WrSession *s = rough_table(&said);
        char path[8];
        static unsigned char bytes[W * H * 4 + 1];
        must_run(s, lines[k]);
        sscanf(lines[k], "export height %7s", path);
        const size_t each = k < 3 ? 2 : 4;
        const bool big = k == 1 || k == 4;
        assert_int_equal(read_bytes(path, bytes, sizeof bytes), W * H * (int)each);
        for (int n = 0; n < W * H; n++) {
            const unsigned char *at = bytes + (size_t)n * each;
            uint32_t word = 0;
            for (size_t b = 0; b < each; b++) word = word << 8 | at[big ? b : each - 1 - b];
            const float f = f_at(s, n % W, n / W);
            float value;
            memcpy(&value, &word, sizeof value);
            if (each == 4) assert_true(value == f);
            else assert_near(word, 65535 * ((double)f + 4) / 7, 0.5001);
        }
        wr_session_free(s);
    }
}

static void expect_same_bytes(const char *a, const char *b)
{
    static unsigned char one[1 << 16], two[1 << 16];
    const size_t length = read_bytes(a, one, sizeof one);
    assert_int_equal(read_bytes(b, two, sizeof two), length);
    assert_memory_equal(one, two, length);
}

static void the_sidecar_says_what_they_are(void **state)
{
    (void)state;
    static const char *const words[] = {
        "\"width\": 45",
        "\"height\": 62",
        "\"type\": \"u16\"",
        "\"endian\": \"big\"",
        "\"low\": -4",
        "\"high\": 3",
        "\"cell\": [90, 62]",
        "\"texel\": [2, 1]",
        "\"height_of_1\": 3.5",
        "\"unit\": \"mm\"",
        "\"wrinkle:wrap\": \"clamp-v\"",
        "\"wrinkle:range\": \"-4,3\"",
    };
    Said said;
    WrSession *s = rough_table(&said);
    must_run(s, "export height h.r16 range=-4,3 endian=big");
    char text[4096] = "", hash[200] = "";
    text[read_bytes("h.r16.json", (unsigned char *)text, sizeof text - 1)] = '\0';
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (!strstr(text, words[k])) fail_msg("without %s:\n%s", words[k], text);
    FILE *sum = popen("sha256sum h.r16", "r");
    assert_int_equal(fscanf(sum, "%64s", hash), 1);
    pclose(sum);
    assert_non_null(strstr(text, hash));
    /* beside a picture only on request */
    must_run(s, "export normal-y n.png");
    assert_int_equal(access("n.png.json", F_OK), -1);
    must_run(s, "export normal-y n.png sidecar=on");
    text[read_bytes("n.png.json", (unsigned char *)text, sizeof text - 1)] = '\0';
    assert_non_null(strstr(text, "\"convention\": \"-Y "));
    assert_non_null(strstr(text, "\"channels\": 3"));
    /* and none beside raw numbers if it is off, for any extension; the numbers are the same */
    must_run(s, "export height h.raw depth=16");
    assert_int_equal(access("h.raw.json", F_OK), 0);
    static const char *const endings[] = { "raw", "r16", "r32" };
    for (int k = 0; k < 3; k++) {
        char line[80], path[40];
        snprintf(line, sizeof line, "export height off.%s sidecar=off", endings[k]);
        must_run(s, line);
        snprintf(path, sizeof path, "off.%s.json", endings[k]);
        assert_int_equal(access(path, F_OK), -1);
    }
    expect_same_bytes("h.raw", "off.raw");
    must_run(s, "export height z.png sidecar=on range=signed");
    text[read_bytes("z.png.json", (unsigned char *)text, sizeof text - 1)] = '\0';
    assert_non_null(strstr(text, "\"zero_code\": 32768"));
    wr_session_free(s);
}

/* ImageMagick reads them with the parameters from the sidecar. */
static void another_program_reads_them(void **state)
{
    (void)state;
    if (system("command -v convert >/dev/null") != 0) skip();
    Said said;
    WrSession *s = rough_table(&said);
    must_run(s, "export height h.r16 range=-4,3 endian=big");
    assert_int_equal(
        system("convert -size 45x62 -depth 16 -endian MSB gray:h.r16 -depth 16 back.pgm"), 0);
    WrError err;
    WrImage *image = wr_image_read("back.pgm", &err);
    if (!image) fail_msg("%s", err.text);
    assert_true(image->width == W && image->height == H);
    for (int n = 0; n < W * H; n++)
        assert_near(-4 + 7 * (double)image->data[n], f_at(s, n % W, n / W), 3.6 / 65535);
    wr_image_free(image);
    wr_session_free(s);
}

/* ---- reading ---- */

static double farthest(const WrSession *a, const WrSession *b)
{
    double most = 0;
    for (int k = 0; k < W * H; k++)
        most = fmax(most, fabs((double)f_at(a, k % W, k / W) - (double)f_at(b, k % W, k / W)));
    return most;
}

static void every_door_opens_them(void **state)
{
    (void)state;
    static const char *const lines[][3] = {
        { "export height h.raw range=-4,3", "image h.raw", "7" },
        { "export height h.r16 range=signed endian=big", "image h.r16", "8" },
        { "export height h.r32 endian=big", "image h.r32", "0" },
        { "export height h.raw range=-4,3", "terrain elevation h.raw", "7" },
        { "export height h.exr depth=16", "image h.exr", "129" },
        { "export normal+y n.raw", "image n.raw", "500" },
    };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        Said said, other;
        WrSession *s = rough_table(&said), *back = listening(&other);
        must_run(back, "table 45x62 wrap=clamp-v");
        must_run(s, lines[k][0]);
        must_run(back, lines[k][1]);
        if (k < 5) assert_near(farthest(s, back), 0, atof(lines[k][2]) / 2 / 65535 + 1e-7);
        if (k != 3) assert_true(doc(back)->scene->cell.w == 90 && doc(back)->scene->cell.mm);
        wr_session_free(back);
        WrError err;
        char *file = strrchr(lines[k][1], ' ') + 1;
        back = wr_session_new(NULL);
        if (!wr_session_open(back, file, &err)) fail_msg("%s", err.text);
        if (k < 5) assert_near(farthest(s, back), 0, atof(lines[k][2]) / 2 / 65535 + 1e-7);
        assert_int_equal(wr_field_wrap_v(wr_document_field(doc(back))), WR_WRAP_CLAMP);
        wr_session_free(back);
        wr_session_free(s);
    }
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void sidecars_that_are_wrong_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        { NULL, "is missing" },
        { "", "JSON" },
        { "[1]", "JSON" },
        { "{\"width\": 2, \"height\": 3", "JSON" },
        { "{\"width\": 2, \"height\": 3}", "type" },
        { "{\"width\": 0, \"height\": 3, \"type\": \"u16\"}", "width" },
        { "{\"width\": 1e9, \"height\": 3, \"type\": \"u16\"}", "width" },
        { "{\"width\": 99999999999, \"height\": 3, \"type\": \"u16\"}", "width" },
        { "{\"width\": \"2\", \"height\": 3, \"type\": \"u16\"}", "width" },
        { "{\"width\": 2, \"height\": 4, \"type\": \"u16\"}", "has 12 bytes" },
        { "{\"width\": 2, \"height\": 3, \"type\": \"f32\"}", "has 12 bytes" },
        { "{\"width\": 2, \"height\": 3, \"type\": \"i16\"}", "type 'i16'" },
        { "{\"width\": 2, \"height\": 3, \"type\": \"u16\", \"endian\": \"middle\"}", "endian" },
        { "{\"width\": 1, \"height\": 1, \"channels\": 6, \"type\": \"u16\"}", "channels" },
        { "{\"width\": 2, \"height\": 3, \"type\": \"u16\", \"sha256\": \"00\"}", "sha256" },
        { "{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{}}}}}}}}}}", "JSON" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        Said said;
        WrSession *s = listening(&said);
        write_text("w.r16", "abcdefghijkl");
        unlink("w.r16.json");
        if (wrong[k][0]) write_text("w.r16.json", wrong[k][0]);
        must_fail(s, "image w.r16", wrong[k][1]);
        wr_session_free(s);
    }
    /* valid files with unused labels are read; NaN and infinities become 0 with a note */
    Said said;
    WrSession *s = listening(&said);
    write_text("w.r16.json", "{\"width\": 2, \"height\": 3, \"type\": \"u16\", \"labels\": 7}");
    must_run(s, "image w.r16");
    assert_near(f_at(s, 0, 0), ('b' * 256 + 'a') / 65535.0, 1e-7);
    write_text("w.r32.json", "{\"width\": 3, \"height\": 1, \"type\": \"f32\"}");
    write_text("w.r32", "abcd\377\377\377\377efgh");
    said.text[0] = '\0';
    must_run(s, "image w.r32");
    assert_true(f_at(s, 1, 0) == 0);
    assert_non_null(strstr(said.text, "not finite"));
    wr_session_free(s);
}

/* ---- failures ---- */

static void a_full_disk_leaves_both_files_as_they_were(void **state)
{
    (void)state;
    Said said;
    WrSession *s = rough_table(&said);
    must_run(s, "export height full.r16");
    must_run(s, "table 300x300");
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = old;
    small.rlim_cur = 50000;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    WrError err = { "" };
    const bool good = wr_session_run(s, "export height full.r16", &err);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, handler);
    assert_false(good);
    if (!strstr(err.text, "cannot be written")) fail_msg("%s", err.text);
    must_run(s, "image full.r16"); /* the old pair is complete: its hash matches */
    assert_int_equal(wr_field_width(wr_document_field(doc(s))), W);
    assert_int_equal(system("ls -A | grep -q part"), 256);
    wr_session_free(s);
}

static void halves_that_do_not_reach_are_refused(void **state)
{
    (void)state;
    Said said;
    WrSession *s = rough_table(&said);
    must_run(s, "fill 65504");
    must_run(s, "export height h.exr depth=16");
    must_run(s, "fill 65521");
    must_fail(s, "export height h.exr depth=16", "65504");
    must_fail(s, "export height h.r16 depth=32", "16 bits");
    must_fail(s, "export height h.raw depth=8", "depth=8");
    must_run(s, "image h.exr"); /* the old file */
    assert_true(f_at(s, 3, 3) == 65504);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_are_the_codes_in_either_order),
        cmocka_unit_test(the_sidecar_says_what_they_are),
        cmocka_unit_test(another_program_reads_them),
        cmocka_unit_test(every_door_opens_them),
        cmocka_unit_test(sidecars_that_are_wrong_are_refused),
        cmocka_unit_test(a_full_disk_leaves_both_files_as_they_were),
        cmocka_unit_test(halves_that_do_not_reach_are_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
