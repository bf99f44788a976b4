/* Brush presets: parsing, meaning, and printing. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/preset.h"
#include "preset_help.h"

#include <libmypaint/mypaint-brush-settings.h>

/* A preset with these settings, which must be valid. */
static WrPreset *with_settings(const char *settings)
{
    WrText text = { 0 };
    WrError err;
    wr_text_addf(&text, "{\"version\": 3, \"settings\": {%s}}", settings);
    WrPreset *preset = parse(text.data, &err);
    if (!preset) fail_msg("%s: %s", text.data, err.text);
    wr_text_fini(&text);
    return preset;
}

static int setting(const char *name)
{
    int index = wr_preset_setting_find(name);
    if (index < 0) fail_msg("no setting %s", name);
    return index;
}

static int input(const char *name)
{
    for (int i = 0; i < wr_preset_input_count(); i++)
        if (strcmp(wr_preset_input(i)->name, name) == 0) return i;
    fail_msg("no input %s", name);
    return -1;
}

/* ---- the table of settings ---- */

static void every_setting_of_the_library_has_its_row(void **state)
{
    (void)state;
    assert_int_equal(wr_preset_setting_count(), MYPAINT_BRUSH_SETTINGS_COUNT);
    for (int i = 0; i < wr_preset_setting_count(); i++) {
        const MyPaintBrushSettingInfo *theirs = mypaint_brush_setting_info((MyPaintBrushSetting)i);
        const WrSettingInfo *ours = wr_preset_setting(i);
        assert_string_equal(ours->name, theirs->cname);
        assert_string_equal(ours->label, theirs->name);
        if (!(ours->low >= theirs->min - 1e-6 && ours->high <= theirs->max + 1e-6))
            fail_msg("%s: %g..%g is wider than %g..%g", ours->name, ours->low, ours->high,
                     (double)theirs->min, (double)theirs->max);
        assert_near(ours->fallback, theirs->def, 1e-6);
        assert_true(ours->fallback >= ours->low && ours->fallback <= ours->high);
        size_t length = strlen(ours->meaning);
        if (length < 12 || ours->meaning[length - 1] != '.')
            fail_msg("%s: '%s' is no sentence", ours->name, ours->meaning);
        assert_int_equal(wr_preset_setting_find(theirs->cname), i);
    }
    assert_int_equal(wr_preset_setting_find("colour"), -1);
}

static void every_input_of_the_library_is_known(void **state)
{
    (void)state;
    assert_int_equal(wr_preset_input_count(), MYPAINT_BRUSH_INPUTS_COUNT);
    for (int i = 0; i < wr_preset_input_count(); i++) {
        const MyPaintBrushInputInfo *theirs = mypaint_brush_input_info((MyPaintBrushInput)i);
        const WrInputInfo *ours = wr_preset_input(i);
        assert_string_equal(ours->name, theirs->cname);
        assert_true(ours->label[0] && ours->help[strlen(ours->help) - 1] == '.');
        if (!(ours->low < ours->high && ours->low >= theirs->soft_min - 0.01 &&
              ours->high <= theirs->soft_max + 0.01))
            fail_msg("%s: %g..%g is wider than %g..%g", ours->name, ours->low, ours->high,
                     (double)theirs->soft_min, (double)theirs->soft_max);
    }
}

static void settings_of_colour_alone_are_ignored(void **state)
{
    (void)state;
    static const char *const colours[] = { "color_h",
                                           "color_s",
                                           "color_v",
                                           "restore_color",
                                           "change_color_h",
                                           "change_color_l",
                                           "change_color_v",
                                           "colorize",
                                           "lock_alpha",
                                           "change_color_hsl_s",
                                           "change_color_hsv_s",
                                           "posterize",
                                           "posterize_num",
                                           "paint_mode" };
    for (size_t i = 0; i < sizeof colours / sizeof *colours; i++)
        assert_int_equal(wr_preset_setting(setting(colours[i]))->use, WR_SETTING_IGNORED);
    assert_int_equal(wr_preset_setting(setting("smudge"))->use, WR_SETTING_MAPPED);
    assert_int_equal(wr_preset_setting(setting("eraser"))->use, WR_SETTING_MAPPED);
    assert_int_equal(wr_preset_setting(setting("snap_to_pixel"))->use, WR_SETTING_USED);
}

/* ---- parsing ---- */

static void the_smallest_preset_is_the_librarys_default_brush(void **state)
{
    (void)state;
    WrPreset *preset = with_settings("");
    WrBrush brush = wr_preset_brush(preset), usual = wr_brush_default();
    assert_near(brush.radius, exp(2.0), 1e-6);
    assert_near(brush.hardness, 0.8, 1e-12);
    assert_int_equal(brush.mode, WR_BRUSH_RAISE);
    assert_true(brush.strength == usual.strength && brush.flow == usual.flow);
    assert_ptr_equal(brush.preset, preset);
    assert_null(brush.tip);
    assert_string_equal(wr_preset_name(preset), "toy");
    assert_string_equal(wr_preset_description(preset), "");
    assert_string_equal(wr_preset_group(preset), "");
    const float(*points)[2];
    assert_int_equal(
        wr_preset_curve(preset, setting("opaque_multiply"), input("pressure"), &points), 2);
    assert_true(points[0][0] == 0 && points[0][1] == 0 && points[1][0] == 1 && points[1][1] == 1);
    assert_int_equal(wr_preset_skipped(preset), 0);
    wr_preset_free(preset);
}

static void values_and_curves_are_those_of_the_file(void **state)
{
    (void)state;
    WrPreset *preset = with_settings(
        "\"hardness\": {\"base_value\": 0.25, \"inputs\": {\"random\": [[0, -0.5], [0.5, -0.5], "
        "[0.5, 0.5], [1, 0.5]]}}, \"opaque_multiply\": {\"base_value\": 1}");
    const float(*points)[2];
    assert_true(wr_preset_value(preset, setting("hardness")) == 0.25);
    assert_false(wr_preset_is_constant(preset, setting("hardness")));
    assert_int_equal(wr_preset_curve(preset, setting("hardness"), input("random"), &points), 4);
    assert_true(points[1][0] == 0.5f && points[2][0] == 0.5f && points[2][1] == 0.5f);
    assert_int_equal(wr_preset_curve(preset, setting("hardness"), input("speed1"), &points), 0);
    /* A setting in the file replaces all defaults of that setting. */
    assert_true(wr_preset_is_constant(preset, setting("opaque_multiply")));
    wr_preset_free(preset);
}

static void unknown_settings_and_inputs_are_passed_over_and_counted(void **state)
{
    (void)state;
    WrPreset *preset = with_settings("\"from_a_later_version\": 7, \"opaque\": {\"base_value\": 1, "
                                     "\"inputs\": {\"surfacemap_x\": 3, \"random\": []}}");
    assert_int_equal(wr_preset_skipped(preset), 2);
    assert_true(wr_preset_is_constant(preset, setting("opaque")));
    wr_preset_free(preset);
}

static void values_beyond_their_range_are_brought_into_it(void **state)
{
    (void)state;
    WrPreset *preset = with_settings(
        "\"radius_logarithmic\": {\"base_value\": 1e30}, "
        "\"dabs_per_actual_radius\": {\"base_value\": 1e6}, "
        "\"hardness\": {\"base_value\": -3}, "
        "\"opaque\": {\"base_value\": 1, \"inputs\": {\"pressure\": [[0, 0], [1, 1e9]]}}");
    const float(*points)[2];
    assert_true(wr_preset_value(preset, setting("radius_logarithmic")) == 6.0);
    assert_true(wr_preset_value(preset, setting("dabs_per_actual_radius")) == 64.0);
    assert_true(wr_preset_value(preset, setting("hardness")) == 0.01);
    assert_int_equal(wr_preset_curve(preset, setting("opaque"), input("pressure"), &points), 2);
    assert_true(points[1][1] == 2.0f); /* limited to the setting's range */
    assert_int_equal(wr_preset_skipped(preset), 4);
    wr_preset_free(preset);
}

static void a_preset_that_erases_gives_mode_erase_unless_it_names_one(void **state)
{
    (void)state;
    WrPreset *preset = with_settings("\"eraser\": {\"base_value\": 1}");
    assert_int_equal(wr_preset_brush(preset).mode, WR_BRUSH_ERASE);
    wr_preset_free(preset);
    preset = with_settings("\"eraser\": {\"base_value\": 0.1}");
    assert_int_equal(wr_preset_brush(preset).mode, WR_BRUSH_RAISE);
    wr_preset_free(preset);
    WrError err;
    preset = parse("{\"version\": 3, \"settings\": {\"eraser\": {\"base_value\": 1}}, "
                   "\"wrinkle\": {\"mode\": \"raise\"}}",
                   &err);
    assert_non_null(preset);
    assert_int_equal(wr_preset_brush(preset).mode, WR_BRUSH_RAISE);
    wr_preset_free(preset);
}

static void presets_say_whether_they_smudge_spray_or_only_colour(void **state)
{
    (void)state;
    static const struct {
        const char *settings;
        bool smudges, sprays, colour_only;
    } rows[] = {
        { "", false, false, false },
        { "\"smudge\": {\"base_value\": 0.3}", true, false, false },
        { "\"smudge\": {\"base_value\": 0, \"inputs\": {\"pressure\": [[0,0],[1,0.5]]}}", true,
          false, false },
        { "\"smudge\": {\"base_value\": 0, \"inputs\": {\"pressure\": [[0,0],[1,-0.5]]}}", false,
          false, false },
        { "\"dabs_per_second\": {\"base_value\": 10}", false, true, false },
        { "\"colorize\": {\"base_value\": 1}", false, false, true },
        { "\"lock_alpha\": {\"base_value\": 1}", false, false, true },
        { "\"lock_alpha\": {\"base_value\": 0.5}", false, false, false },
        { "\"opaque\": {\"base_value\": 0}", false, false, true },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrPreset *preset = with_settings(rows[i].settings);
        assert_int_equal(wr_preset_smudges(preset), rows[i].smudges);
        assert_int_equal(wr_preset_sprays(preset), rows[i].sprays);
        assert_int_equal(wr_preset_is_colour_only(preset), rows[i].colour_only);
        wr_preset_free(preset);
    }
}

static void the_relief_part_sets_the_brush(void **state)
{
    (void)state;
    WrError err;
    WrPreset *preset = with_relief(
        "{\"mode\": \"lower\", \"strength\": 0.25, \"to\": -1, \"opacity\": 0.5, \"flow\": 0.125, "
        "\"buildup\": true, \"reach\": 3, \"radius\": 700, \"aspect\": 2, \"angle\": 30, "
        "\"follow\": true, \"jitter\": [0.5, 10, 0.25]}",
        &err);
    if (!preset) fail_msg("%s", err.text);
    WrBrush brush = wr_preset_brush(preset);
    assert_int_equal(brush.mode, WR_BRUSH_LOWER);
    assert_true(brush.strength == 0.25 && brush.to == -1 && brush.opacity == 0.5);
    assert_true(brush.flow == 0.125 && brush.buildup && brush.reach == 3 && brush.radius == 700);
    assert_true(brush.aspect == 2 && brush.angle_deg == 30 && brush.follow);
    assert_true(brush.jitter_place == 0.5 && brush.jitter_angle_deg == 10);
    assert_true(brush.jitter_size == 0.25);
    wr_preset_free(preset);
}

/* ---- printing, and presets made from others ---- */

static void printing_and_reading_give_the_same_text_again(void **state)
{
    (void)state;
    WrError err;
    WrPreset *preset = parse(
        "{\"version\": 3, \"comment\": \"a \\\"quote\\\"\\n\", \"group\": \"Gr\\u00fcn\", "
        "\"description\": \"d\", \"notes\": \"n\", \"settings\": {\"radius_logarithmic\": "
        "{\"base_value\": 2.7182818284590452}, \"opaque\": {\"base_value\": 0.1, \"inputs\": "
        "{\"pressure\": [[0, 0.1], [0.3, 0.1], [1, 1]], \"speed1\": [[0, -1e-7], [4, 0.3]]}}}, "
        "\"wrinkle\": {\"mode\": \"erode\", \"strength\": 0.1, \"jitter\": [0.1, 0, 0]}}",
        &err);
    if (!preset) fail_msg("%s", err.text);
    WrBrush brush = wr_preset_brush(preset);
    WrText first = { 0 }, second = { 0 };
    wr_preset_print(preset, &brush, &first);
    WrPreset *again = parse(first.data, &err);
    if (!again) fail_msg("%s", err.text);
    WrBrush same = wr_preset_brush(again);
    wr_preset_print(again, &same, &second);
    assert_string_equal(first.data, second.data);
    assert_true(same.radius == brush.radius && same.mode == WR_BRUSH_ERODE);
    assert_string_equal(wr_preset_group(again), "Gr\xc3\xbcn");
    for (int i = 0; i < wr_preset_setting_count(); i++)
        if (i != setting("radius_logarithmic"))
            assert_true(same_bits(wr_preset_value(preset, i), wr_preset_value(again, i)));
    const float(*points)[2];
    assert_int_equal(wr_preset_curve(again, setting("opaque"), input("speed1"), &points), 2);
    assert_true(points[0][1] == -1e-7f && points[1][1] == 0.3f);
    wr_text_fini(&first);
    wr_text_fini(&second);
    wr_preset_free(again);
    wr_preset_free(preset);
}

/* The logarithm in the file cannot represent a radius exactly; the result is rounded to a millionth. */
static void a_brushs_radius_survives_its_logarithm(void **state)
{
    (void)state;
    static const double radii[] = { 0.2, 0.7, 1, 1.5, 3.3, 16, 40.25, 100, 403, 404, 5000, 1e6 };
    WrPreset *preset = with_settings("");
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        WrError err;
        WrText text = { 0 };
        WrBrush brush = wr_preset_brush(preset);
        brush.radius = radii[i];
        wr_preset_print(preset, &brush, &text);
        WrPreset *again = parse(text.data, &err);
        if (!again) fail_msg("%s", err.text);
        assert_true(wr_preset_brush(again).radius == radii[i]);
        wr_preset_free(again);
        wr_text_fini(&text);
    }
    wr_preset_free(preset);
}

static void with_changes_values_and_names_what_is_wrong(void **state)
{
    (void)state;
    WrError err;
    WrPreset *preset = with_settings("\"opaque\": {\"base_value\": 1, \"inputs\": {\"pressure\": "
                                     "[[0, 0], [1, 1]]}}");
    WrPreset *other = wr_preset_with(preset, "slow_tracking=2;opaque=0.5", &err);
    if (!other) fail_msg("%s", err.text);
    assert_true(wr_preset_value(other, setting("slow_tracking")) == 2.0);
    assert_true(wr_preset_value(other, setting("opaque")) == 0.5);
    assert_false(wr_preset_is_constant(other, setting("opaque"))); /* curves stay */
    assert_true(wr_preset_value(preset, setting("opaque")) == 1.0);
    wr_preset_free(other);
    static const struct {
        const char *settings, *words;
    } wrong[] = {
        { "slow=1", "'slow' is not a setting" },      { "opaque", "must be NAME=VALUE" },
        { "opaque=3", "opaque=3: must be 0..2" },     { "opaque=", "opaque=: must be 0..2" },
        { "opaque=nan", "opaque=nan: must be 0..2" }, { "=1", "'' is not a setting" }
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_null(wr_preset_with(preset, wrong[i].settings, &err));
        if (!strstr(err.text, wrong[i].words)) fail_msg("'%s'", err.text);
    }
    wr_preset_free(preset);
}

static void assert_curve(const WrPreset *preset, const char *set, const char *by,
                         const float (*want)[2], int count)
{
    const float(*got)[2] = NULL;
    assert_int_equal(wr_preset_curve(preset, setting(set), input(by), &got), count);
    if (count > 0) assert_memory_equal(got, want, sizeof *want * (size_t)count);
}

static void with_draws_curves_which_files_keep(void **state)
{
    (void)state;
    WrError err;
    static const float own[][2] = { { 0, 0.1f }, { 0.7f, 0.3f } },
                       line[][2] = { { 0, 0 }, { 1, 1 } };
    static const float drawn[][2] = {
        { 0.05f, -0.31f }, { 0.4f, 0.2f }, { 0.4f, 0.7f }, { 1.3f, 1.9f }
    };
    static const float wobble[][2] = { { 0, -0.3f }, { 1, 0.33333334f } };
    WrPreset *preset = with_settings("\"opaque\": {\"base_value\": 0.7, \"inputs\": {\"pressure\": "
                                     "[[0, 0], [1, 1]], \"speed1\": [[0, 0.1], [0.7, 0.3]]}}");
    WrPreset *other = wr_preset_with(preset,
                                     "opaque:pressure=0.05,-0.31|0.4,0.2|0.4,0.7|1.3,1.9;"
                                     "hardness:random=0,-0.3|1,0.333333333;slow_tracking=2",
                                     &err);
    if (!other) fail_msg("%s", err.text);
    WrText text = { 0 };
    for (int round = 0; round < 2; round++) { /* as created, and as read from its own file */
        assert_curve(other, "opaque", "pressure", drawn, 4);
        assert_curve(other, "opaque", "speed1", own, 2);
        assert_curve(other, "hardness", "random", wobble, 2);
        assert_curve(other, "hardness", "pressure", NULL, 0);
        assert_true(wr_preset_value(other, setting("opaque")) == 0.7);
        assert_true(wr_preset_value(other, setting("slow_tracking")) == 2.0);
        WrBrush brush = wr_preset_brush(other);
        wr_text_clear(&text);
        wr_preset_print(other, &brush, &text);
        wr_preset_free(other);
        other = parse(wr_text_get(&text), &err);
        if (!other) fail_msg("%s", err.text);
    }
    wr_preset_free(other);
    assert_curve(preset, "opaque", "pressure", line, 2); /* unchanged */
    other = wr_preset_with(preset, "opaque:pressure=;opaque:speed1=0,1|1,0;opaque:speed1=", &err);
    if (!other) fail_msg("%s", err.text);
    assert_true(wr_preset_is_constant(other, setting("opaque")));
    wr_preset_free(other);
    static const struct {
        const char *settings, *words;
    } wrong[] = {
        { "opaque:pressur=0,0|1,1", "opaque:pressur: unknown input" },
        { "opak:pressure=0,0|1,1", "'opak' is not a setting" },
        { "opaque:pressure=0,0", "one point: must be 2..64" },
        { "opaque:pressure=0,0|1", "point '1': must be x,y" },
        { "opaque:pressure=0,0|1,1,1", "point '1,1,1': must be x,y" },
        { "opaque:pressure=0,0|1,2.01", "-2..2" },
        { "opaque:pressure=0,0|nan,1", "point 'nan,1'" },
        { "opaque:pressure=0,0|1e10,1", "point '1e10,1'" },
        { "opaque:pressure=0.5,0|0.4,1", "point '0.4,1': its x must not be below" },
        { "opaque:pressure", "must be NAME=VALUE or NAME:INPUT" },
        { "opaque:=0,0|1,1", "opaque:: unknown input" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_null(wr_preset_with(preset, wrong[i].settings, &err));
        if (!strstr(err.text, wrong[i].words)) fail_msg("'%s'", err.text);
    }
    wr_text_clear(&text);
    wr_text_add(&text, "opaque:pressure=0,0");
    for (int i = 1; i < 65; i++) wr_text_addf(&text, "|%d,0", i);
    assert_null(wr_preset_with(preset, wr_text_get(&text), &err));
    assert_non_null(strstr(err.text, "more than 64 points"));
    wr_text_fini(&text);
    wr_preset_free(preset);
}

static void a_shared_preset_lives_until_its_last_owner(void **state)
{
    (void)state;
    WrPreset *preset = with_settings("");
    WrPreset *other = wr_preset_share(preset);
    wr_preset_free(preset);
    assert_string_equal(wr_preset_name(other), "toy");
    wr_preset_free(other);
    wr_preset_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_setting_of_the_library_has_its_row),
        cmocka_unit_test(every_input_of_the_library_is_known),
        cmocka_unit_test(settings_of_colour_alone_are_ignored),
        cmocka_unit_test(the_smallest_preset_is_the_librarys_default_brush),
        cmocka_unit_test(values_and_curves_are_those_of_the_file),
        cmocka_unit_test(unknown_settings_and_inputs_are_passed_over_and_counted),
        cmocka_unit_test(values_beyond_their_range_are_brought_into_it),
        cmocka_unit_test(a_preset_that_erases_gives_mode_erase_unless_it_names_one),
        cmocka_unit_test(presets_say_whether_they_smudge_spray_or_only_colour),
        cmocka_unit_test(the_relief_part_sets_the_brush),
        cmocka_unit_test(printing_and_reading_give_the_same_text_again),
        cmocka_unit_test(a_brushs_radius_survives_its_logarithm),
        cmocka_unit_test(with_changes_values_and_names_what_is_wrong),
        cmocka_unit_test(with_draws_curves_which_files_keep),
        cmocka_unit_test(a_shared_preset_lives_until_its_last_owner),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
