/* Invalid brush presets: refusals and their messages. Tips beside presets. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/preset.h"
#include "preset_help.h"

static void refuse(const char *text, const char *words)
{
    WrError err;
    WrPreset *preset = parse(text, &err);
    if (preset) fail_msg("%s: was read", text);
    if (!strstr(err.text, "toy") || !strstr(err.text, words))
        fail_msg("%s: '%s' does not say '%s'", text, err.text, words);
}

static void refuse_settings(const char *settings, const char *words)
{
    WrText text = { 0 };
    wr_text_addf(&text, "{\"version\": 3, \"settings\": {%s}}", settings);
    refuse(text.data, words);
    wr_text_fini(&text);
}

static void refuse_relief(const char *relief, const char *words)
{
    WrError err;
    WrPreset *preset = with_relief(relief, &err);
    if (preset) fail_msg("%s: was read", relief);
    if (!strstr(err.text, words)) fail_msg("%s: '%s' does not say '%s'", relief, err.text, words);
}

/* ---- refusals ---- */

static void text_that_is_no_preset_is_refused_with_its_place(void **state)
{
    (void)state;
    refuse("", "too early");
    refuse("{", "too early");
    refuse("null ", "null");
    refuse("[]", "a JSON object");
    refuse("3 ", "must be a JSON object");
    refuse("{\"version\": 3, \"settings\": {}} {}", "byte 31");
    refuse("{\"version\": 3, \"settings\": {},}", "byte");
    refuse("{\"version\": 3, \"settings\": {}, \"comment\": \"\xff\xfe\"}", "byte");
    refuse("\"radius\" 3", "JSON object");
    refuse("# brush preset, version 2\nopaque 1.0", "byte");
}

static void bytes_after_a_nul_are_not_overlooked(void **state)
{
    (void)state;
    static const char text[] = "{\"version\": 3, \"settings\": {}}\0{}";
    WrError err;
    assert_null(wr_preset_parse(text, sizeof text - 1, "toy", NULL, &err));
    assert_non_null(strstr(err.text, "after the JSON object"));
}

static void deep_nesting_and_size_are_limited(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrError err;
    for (int i = 0; i < 100000; i++) wr_text_add(&text, "[");
    assert_null(parse(text.data, &err));
    wr_text_clear(&text);
    for (int i = 0; i <= WR_PRESET_BYTES; i++) wr_text_add(&text, " ");
    assert_null(parse(text.data, &err));
    assert_non_null(strstr(err.text, "at most 1048576"));
    wr_text_fini(&text);
}

static void other_versions_are_refused(void **state)
{
    (void)state;
    refuse("{\"settings\": {}}", "version: is not there: must be 3");
    refuse("{\"version\": 2, \"settings\": {}}", "version: 2: must be 3");
    refuse("{\"version\": \"3\", \"settings\": {}}", "version: \"3\": must be 3");
    refuse("{\"version\": 3.5, \"settings\": {}}", "must be 3");
}

static void members_of_the_wrong_kind_are_refused(void **state)
{
    (void)state;
    refuse("{\"version\": 3}", "settings: is not there");
    refuse("{\"version\": 3, \"settings\": []}", "settings: []: must be an object");
    refuse("{\"version\": 3, \"settings\": null}", "settings: null");
    refuse("{\"version\": 3, \"settings\": {}, \"comment\": 5}", "comment: 5: must be a text");
    refuse("{\"version\": 3, \"settings\": {}, \"group\": \"a\\u0000b\"}", "without \\u0000");
    refuse_settings("\"opaque\": 1", "opaque: 1: must be an object");
    refuse_settings("\"opaque\": {}", "opaque: base_value: is not there");
    refuse_settings("\"opaque\": {\"base_value\": \"1\"}", "opaque: base_value: \"1\"");
    refuse_settings("\"opaque\": {\"base_value\": null}", "opaque: base_value: null");
    refuse_settings("\"opaque\": {\"base_value\": 1e999}", "opaque: base_value");
    refuse_settings("\"opaque\": {\"base_value\": NaN}", "toy");
    refuse_settings("\"opaque\": {\"base_value\": 1, \"inputs\": []}", "opaque: inputs: []");
}

/* Each of these makes libmypaint's own parser abort or crash. */
static void curves_that_the_library_would_abort_on_are_refused(void **state)
{
    (void)state;
#define CURVE(points) "\"hardness\": {\"base_value\": 1, \"inputs\": {\"pressure\": " points "}}"
    refuse_settings(CURVE("[[0, 0]]"), "hardness: pressure: 1 points: must be 2..64");
    refuse_settings(CURVE("[[0, 0], [1, 1], [0.5, 1]]"), "not below");
    refuse_settings(CURVE("[1, 2]"), "hardness: pressure: 1: must be points");
    refuse_settings(CURVE("[[0, 0], [1]]"), "must be points");
    refuse_settings(CURVE("[[0, 0], [1, 1, 1]]"), "must be points");
    refuse_settings(CURVE("[[0, 0], [1, \"a\"]]"), "hardness: pressure: \"a\"");
    refuse_settings(CURVE("[[0, 0], [1, 1e400]]"), "hardness: pressure");
    refuse_settings(CURVE("{}"), "must be a list");
#undef CURVE
    WrText text = { 0 };
    for (int i = 0; i < 65; i++) wr_text_addf(&text, "%s[%d, 0]", i ? "," : "", i);
    WrText all = { 0 };
    wr_text_addf(&all, "\"hardness\": {\"base_value\": 1, \"inputs\": {\"random\": [%s]}}",
                 text.data);
    refuse_settings(all.data, "65 points: must be 2..64");
    wr_text_fini(&all);
    wr_text_fini(&text);
}

static void a_wrong_relief_part_is_refused_by_member_and_range(void **state)
{
    (void)state;
    refuse_relief("[]", "wrinkle: []: must be an object");
    refuse_relief("{\"mode\": \"rise\"}",
                  "mode: \"rise\": did you mean raise? It must be one of raise, lower");
    refuse_relief("{\"mode\": 1}", "mode: 1: must be one of");
    refuse_relief("{\"flow\": 2}", "wrinkle: flow: 2: must be a number from 0 to 1");
    refuse_relief("{\"flow\": \"x\"}", "wrinkle: flow: \"x\": must be a number from 0 to 1");
    refuse_relief("{\"strength\": 1e31}", "strength");
    refuse_relief("{\"aspect\": 0.5}", "aspect: 0.5: must be a number from 1 to 100");
    refuse_relief("{\"buildup\": 1}", "buildup: 1: must be true or false");
    refuse_relief("{\"jitter\": [1, 2]}", "jitter: [1,2]: must be a list");
    refuse_relief("{\"jitter\": [1, 2, 3]}", "jitter: 3: must be a number from 0 to 1");
    refuse_relief("{\"strenght\": 1}", "strenght: is not known: must be mode, strength");
}

/* ---- tips ---- */

static void tips_need_a_plain_name_and_their_hash(void **state)
{
    (void)state;
    static const char *const names[] = {
        "../a.png", "/etc/passwd", "a/b.png", "", ".hidden", ".."
    };
    char text[200];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(text, sizeof text, "{\"tip\": \"%s\", \"tip_sha256\": \"%064d\"}", names[i], 0);
        refuse_relief(text, "the plain name of a file");
    }
    refuse_relief("{\"tip\": \"a.png\"}", "tip_sha256: is not there");
    refuse_relief("{\"tip\": \"a.png\", \"tip_sha256\": \"12\"}", "64 hex digits");
    snprintf(text, sizeof text, "{\"tip_sha256\": \"%064d\"}", 0);
    refuse_relief(text, "tip: is not there");
    snprintf(text, sizeof text, "{\"tip\": \"a.png\", \"tip_sha256\": \"%064d\"}", 0);
    refuse_relief(text, "only a preset in a file can have a tip");
}

/* A GIMP brush of version 1: 2 x 2 grey pixels. */
static const unsigned char tip_bytes[] = { 0, 0, 0, 24, 0, 0, 0,   1,   0,   0, 0,   2,   0,   0,
                                           0, 2, 0, 0,  0, 1, 't', 'i', 'p', 0, 255, 128, 128, 0 };

static char *scratch_folder(void)
{
    char *folder = wr_strdup("/tmp/wrinkle-preset-XXXXXX");
    assert_non_null(mkdtemp(folder));
    return folder;
}

static void write_beside(const char *folder, const char *name, const void *bytes, size_t size)
{
    WrError err;
    char *path = wr_path_join(folder, name);
    if (!wr_file_write(path, bytes, size, &err)) fail_msg("%s", err.text);
    wr_free(path);
}

static WrPreset *read_beside(const char *folder, const char *name, WrError *err)
{
    char *path = wr_path_join(folder, name);
    WrPreset *preset = wr_preset_read(path, "toy", err);
    wr_free(path);
    return preset;
}

static void a_tip_is_read_beside_its_preset_and_must_have_its_hash(void **state)
{
    (void)state;
    char *folder = scratch_folder(), hex[65];
    WrError err;
    WrText text = { 0 };
    wr_sha256_bytes(tip_bytes, sizeof tip_bytes, hex);
    wr_text_addf(&text,
                 "{\"version\": 3, \"settings\": {}, \"wrinkle\": {\"tip\": \"t.gbr\", "
                 "\"tip_sha256\": \"%s\"}}",
                 hex);
    write_beside(folder, "p.myb", text.data, text.length);
    assert_null(read_beside(folder, "p.myb", &err)); /* no tip there yet */
    assert_non_null(strstr(err.text, "t.gbr"));
    write_beside(folder, "t.gbr", tip_bytes, sizeof tip_bytes);
    WrPreset *preset = read_beside(folder, "p.myb", &err);
    if (!preset) fail_msg("%s", err.text);
    assert_non_null(wr_preset_tip(preset));
    assert_string_equal(wr_preset_tip_file(preset), "t.gbr");
    WrBrush brush = wr_preset_brush(preset);
    assert_ptr_equal(brush.tip, wr_preset_tip(preset));
    wr_text_clear(&text);
    wr_preset_print(preset, &brush, &text);
    assert_non_null(strstr(text.data, "\"tip\": \"t.gbr\""));
    assert_non_null(strstr(text.data, hex));
    wr_preset_free(preset);
    write_beside(folder, "t.gbr", tip_bytes, sizeof tip_bytes - 1); /* another content */
    assert_null(read_beside(folder, "p.myb", &err));
    assert_non_null(strstr(err.text, "SHA-256"));
    wr_text_fini(&text);
    wr_text_addf(&text, "rm -r %s", folder);
    assert_int_equal(system(text.data), 0);
    wr_text_fini(&text);
    wr_free(folder);
}

/* Any one byte of a valid preset changed, or the text truncated anywhere: an error or a preset, nothing else. */
static void damaged_text_is_an_error_or_a_preset(void **state)
{
    (void)state;
    WrError wrong;
    WrPreset *preset = parse("{\"version\": 3, \"settings\": {}}", &wrong);
    WrBrush brush = wr_preset_brush(preset);
    WrText text = { 0 };
    wr_preset_print(preset, &brush, &text);
    TestRandom random = { 5 };
    int refused = 0;
    for (int i = 0; i < 3000; i++) {
        WrError err = { "" };
        size_t at = test_random_u64(&random) % text.length;
        char kept = text.data[at];
        text.data[at] = (char)test_random_u64(&random);
        size_t length = i % 3 ? text.length : test_random_u64(&random) % text.length;
        WrPreset *made = wr_preset_parse(text.data, length, "toy", NULL, &err);
        assert_true(made || err.text[0]);
        refused += !made;
        wr_preset_free(made);
        text.data[at] = kept;
    }
    assert_true(refused > 1000);
    wr_text_fini(&text);
    wr_preset_free(preset);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_that_is_no_preset_is_refused_with_its_place),
        cmocka_unit_test(bytes_after_a_nul_are_not_overlooked),
        cmocka_unit_test(deep_nesting_and_size_are_limited),
        cmocka_unit_test(other_versions_are_refused),
        cmocka_unit_test(members_of_the_wrong_kind_are_refused),
        cmocka_unit_test(curves_that_the_library_would_abort_on_are_refused),
        cmocka_unit_test(a_wrong_relief_part_is_refused_by_member_and_range),
        cmocka_unit_test(tips_need_a_plain_name_and_their_hash),
        cmocka_unit_test(a_tip_is_read_beside_its_preset_and_must_have_its_hash),
        cmocka_unit_test(damaged_text_is_an_error_or_a_preset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
