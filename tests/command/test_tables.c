/* Tables with a compile-time count have texts and functions in every row, and so have terminated lists. */
#include "test.h"
#include "field/scheme_list.h"

#include "command/command_table.h"
#include "document/blend.h"
#include "document/document_file.h"
#include "export/export.h"
#include "field/ops.h"
#include "field/ramp.h"
#include "field/scheme.h"
#include "field/select.h"
#include "brush/brush.h"
#include "brush/mode.h"
#include "noise/octaves.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/bump.h"

/* A non-empty text that no earlier row has. */
static void is_new(const char *table, int row, const char *word, const char *(*before)(int row))
{
    if (!word || !*word) fail_msg("%s: row %d has no word", table, row);
    for (int i = 0; before && i < row; i++)
        if (strcmp(before(i), word) == 0)
            fail_msg("%s: rows %d and %d are %s", table, i, row, word);
}

#define NAME_OF(function, expression)                                                              \
    static const char *function(int i)                                                             \
    {                                                                                              \
        return expression;                                                                         \
    }
NAME_OF(scheme, wr_schemes[i].name)
NAME_OF(scheme_title, wr_schemes[i].title)
NAME_OF(bump, wr_bumps[i].name)
NAME_OF(bump_title, wr_bumps[i].title)
NAME_OF(brush_mode, wr_brush_modes[i].name)
NAME_OF(pressure, wr_brush_pressures[i])
NAME_OF(blend, wr_blends[i].name)
NAME_OF(surface, wr_surfaces[i]->name)
NAME_OF(kind_of_export, wr_export_kinds[i].name)
NAME_OF(noise, wr_noises[i].name)
NAME_OF(fade, wr_fade_words[i])
NAME_OF(octaves, wr_octaves_words[i])
NAME_OF(axis, wr_axis_labels[i])
NAME_OF(tolerance, wr_tolerance_names[i])
NAME_OF(light, wr_light_kinds[i].name)
NAME_OF(camera, wr_camera_names[i])
NAME_OF(join, wr_select_modes[i])
NAME_OF(ramp, wr_ramp_names[i])
NAME_OF(ramp_blend, wr_blends[wr_ramp_blends[i]].name)
NAME_OF(wrap, wr_document_wrap_name(i))
NAME_OF(class_name, wr_class_names[i])
NAME_OF(type, wr_arg_type_names[i])

static void every_word_has_a_row(void **state)
{
    (void)state;
    static const struct {
        const char *table;
        int count;
        const char *(*word)(int row);
    } tables[] = {
        { "schemes", WR_SCHEME_COUNT, scheme },
        { "schemes' titles", WR_SCHEME_COUNT, scheme_title },
        { "normals", WR_BUMP_COUNT, bump },
        { "normals' titles", WR_BUMP_COUNT, bump_title },
        { "brush modes", WR_BRUSH_MODE_COUNT, brush_mode },
        { "pressures", WR_PRESSURE_COUNT, pressure },
        { "blends", WR_BLEND_COUNT, blend },
        { "surfaces", WR_SURFACE_COUNT, surface },
        { "exports", WR_EXPORT_KIND_COUNT, kind_of_export },
        { "noises", WR_NOISE_KIND_COUNT, noise },
        { "fades", WR_FADE_COUNT, fade },
        { "sums of octaves", WR_OCTAVES_MODE_COUNT, octaves },
        { "axes", WR_AXIS_COUNT, axis },
        { "tolerances", WR_TOLERANCE_COUNT, tolerance },
        { "lights", WR_LIGHT_KINDS, light },
        { "cameras", 2, camera },
        { "joins", WR_SELECT_MODES, join },
        { "ramps", WR_RAMP_KINDS, ramp },
        { "ramps' blends", WR_RAMP_BLENDS, ramp_blend },
        { "wraps", WR_DOCUMENT_WRAPS, wrap },
        { "classes", WR_CLASS_COUNT, class_name },
        { "types", WR_ARG_TYPES, type },
    };
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
        for (int i = 0; i < tables[t].count; i++)
            is_new(tables[t].table, i, tables[t].word(i), tables[t].word);
    assert_null(wr_select_modes[WR_SELECT_MODES]);
    assert_null(wr_document_wrap_name(WR_DOCUMENT_WRAPS));
}

static void every_row_does_something(void **state)
{
    (void)state;
    for (int i = 0; i < WR_SCHEME_COUNT; i++) {
        assert_non_null(wr_schemes[i].eval);
        assert_true(wr_schemes[i].order_f > 0 && wr_schemes[i].reach > 0);
    }
    for (int i = 0; i < WR_BRUSH_MODE_COUNT; i++) {
        const WrBrushModeInfo *mode = &wr_brush_modes[i];
        assert_non_null(mode->work);
        assert_true(mode->spacing > 0);
        assert_int_equal(mode->moves, mode->work->move != NULL);
        assert_int_equal(mode->moves, mode->work->cover == NULL);
    }
    for (int i = 0; i < WR_BLEND_COUNT; i++) assert_non_null(wr_blends[i].span);
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++) {
        const WrExportKind *kind = &wr_export_kinds[i];
        assert_true(kind->write || (kind->rows && kind->describe));
        assert_true(kind->channels > 0 || kind->ending); /* solids have none */
    }
    for (int i = 0; i < wr_op_count; i++) {
        is_new("operations", i, wr_ops[i].name, NULL);
        assert_non_null(wr_ops[i].label);
        assert_non_null(wr_ops[i].run);
    }
    assert_null(wr_ops[wr_op_count].name);
    for (int i = 0; i < wr_command_count; i++) {
        assert_non_null(wr_commands[i]->help);
        assert_non_null(wr_commands[i]->example);
        assert_in_range(wr_commands[i]->kind, 0, WR_CLASS_COUNT - 1);
    }
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            assert_string_equal(g->family, f->name);
            assert_non_null(g->make);
            assert_non_null(g->params);
            assert_true(wr_blend_find(g->blend) >= 0);
        }
}

static void every_dial_can_be_turned_to_each_of_its_rungs(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        is_new("dials", d, dial->name, NULL);
        for (int rung = 0; rung < dial->choices; rung++) {
            is_new(dial->name, rung, dial->choice(rung), dial->choice);
            dial->set(scene, rung);
            assert_true(dial->get(scene) == rung);
        }
        if (dial->choices > 0) assert_null(dial->choice(dial->choices));
        else assert_true(dial->low < dial->high && dial->rungs);
    }
    wr_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_word_has_a_row),
        cmocka_unit_test(every_row_does_something),
        cmocka_unit_test(every_dial_can_be_turned_to_each_of_its_rungs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
