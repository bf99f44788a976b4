/* The table of hard cases: complete, passing, able to fail, and printed in a parsable form. */
#include "test.h"

#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"
#include "hardcases/hardcases.h"

#include <json-c/json.h>

static const char *const ids[] = {
    "HC01",  "HC02",  "HC03",  "HC04",  "HC05",  "HC06",  "HC07",  "HC08",  "HC09",  "HC10",
    "HC11",  "HC12",  "HC13",  "HC14",  "HC15",  "HC16",  "HC17",  "HC18",  "HC19",  "HC20",
    "HC21",  "HC22",  "HC23",  "HC24",  "HC25",  "HC26",  "HC27",  "HC28",  "HC29",  "HC30",
    "HC31",  "HC32",  "HC33",  "HC34",  "HC35",  "HC36",  "HC37",  "HC38",  "HC39",  "HC40",
    "HC41",  "HC42",  "HC43",  "HC44",  "HC45",  "HC46",  "HC47",  "HC48",  "HC49",  "HC50",
    "HC51",  "HC52",  "HC53",  "HC54",  "HC55",  "HC56",  "HC57",  "HC58",  "HC59",  "HC60",
    "HC61",  "HC62",  "HC63",  "HC64",  "HC65",  "HC66",  "HC67",  "HC68",  "HC69",  "HC70",
    "HC71",  "HC72",  "HC73",  "HC74",  "HC75",  "HC76",  "HC77",  "HC78",  "HC79",  "HC80",
    "HC81",  "HC82",  "HC83",  "HC84",  "HC85",  "HC86",  "HC87",  "HC88",  "HC89",  "HC90",
    "HC91",  "HC92",  "HC93",  "HC94",  "HC95",  "HC96",  "HC97",  "HC98",  "HC99",  "HC100",
    "HC102", "HC104", "HC105", "HC107", "HC108", "HC110", "HC101", "HC111", "HC112", "HC113",
    "HC114", "HC115", "HC116", "HC117", "HC118", "HC119", "HC120", "HC121", "HC122", "HC123",
    "HC124", "HC125", "HC126", "HC127", "HC128", "HC129", "HC130", "HC131", "HC132", "HC133",
    "HC134", "HC135", "HC136", "HC137", "HC138", "HC139", "HC140", "HC141", "HC142", "HC143",
    "HC144", "HC149", "HC150", "HC151", "HC152", "HC153", "HC154", "HC156", "HC157", "HC158",
    "HC159", "HC160", "HC161", "HC162", "HC163", "HC164", "HC165", "HC166", "HC167", "HC168",
    "HC169", "HC170", "HC171", "HC172", "HC173", "HC174", "HC175", "HC176", "HC177", "HC178",
    "HC179", "HC190", "HC191",
};

static void all_are_there_once_and_in_order(void **state)
{
    (void)state;
    assert_int_equal(sizeof ids / sizeof *ids, WR_HARDCASES);
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        assert_non_null(row);
        assert_string_equal(row->id, ids[i]);
        assert_ptr_equal(wr_hardcase_find(ids[i]), row);
    }
    assert_null(wr_hardcase(WR_HARDCASES));
    assert_null(wr_hardcase_find("HC103"));
    assert_null(wr_hardcase_find("HC1"));
}

static void every_row_says_what_must_hold_and_is_measured_or_waits(void **state)
{
    (void)state;
    int subject = 0;
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        assert_true(strlen(row->what) > 5 && strlen(row->holds) > 2 && strlen(row->unit) > 1);
        if (i == 96) subject = 0; /* further ones have subjects in any order */
        assert_true(row->subject < WR_HARD_SUBJECTS);
        assert_true(i >= 96 || (int)row->subject >= subject);
        subject = (int)row->subject;
        if (!row->measure) assert_non_null(row->waits);
        int bounds = 0;
        for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
            assert_true(isnan(row->bound[p]) || row->bound[p] >= 0.0);
            bounds += !isnan(row->bound[p]);
        }
        assert_true(bounds > 0);
    }
}

/* All of them, measured once on three threads. */
static const WrHardReport *by_three_threads(void)
{
    static WrHardReport report;
    WrError err = { "" };
    if (report.results[0].row) return &report;
    WrPool *pool = wr_pool_new(3);
    const WrHardRequest request = { .pool = pool };
    if (!wr_hardcases_run(&request, &report, &err)) fail_msg("%s", err.text);
    wr_pool_free(pool);
    return &report;
}

static void none_fails_and_what_is_to_come_never_passes(void **state)
{
    (void)state;
    const WrHardReport *report = by_three_threads();
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *r = &report->results[i];
        assert_ptr_equal(r->row, wr_hardcase(i));
        /* and a partly waiting one does not pass */
        const bool whole = r->row->measure && !r->row->waits;
        if (r->verdict != (whole ? WR_HARD_PASS : WR_HARD_WAITS))
            fail_msg("%s: %s, float %g of %g, double %g of %g %s", ids[i],
                     wr_hard_verdicts[r->verdict], r->worst[0], r->row->bound[0], r->worst[1],
                     r->row->bound[1], r->note);
        for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
            assert_true((r->checks[p] > 0) == !isnan(r->worst[p]));
            if (!r->row->measure) assert_int_equal(r->checks[p], 0);
        }
    }
    assert_int_equal(report->count[WR_HARD_PASS] + report->count[WR_HARD_WAITS], WR_HARDCASES);
    assert_true(report->count[WR_HARD_PASS] >= 124 && report->count[WR_HARD_FAIL] == 0);
}

/* The bound exceeded by half of it, or by one if it is 0: in one precision at a time. In an ordinary run every
   third, in one precision. */
static void every_measured_row_can_fail_in_every_precision(void **state)
{
    (void)state;
    for (int i = 0; i < WR_HARDCASES; i += test_step(3, 3)) {
        const WrHardCase *row = wr_hardcase(i);
        for (int p = 0; p < WR_HARD_PRECISIONS && row->measure; p++) {
            WrHardRequest request = { 0 };
            WrHardResult result;
            const bool other = !isnan(row->bound[1 - p]);
            if (isnan(row->bound[p]) || (other && (i / 3 + p) % test_step(2, 2) != 0)) continue;
            request.nudge[p] = row->bound[p] > 0.0 ? 2.5 * row->bound[p] : 1.0;
            assert_true(wr_hardcase_run(row, &request, &result, NULL));
            if (result.verdict != WR_HARD_FAIL || !(result.worst[p] > row->bound[p]))
                fail_msg("%s %s with %g on top: %s, %g", ids[i], p ? "double" : "float",
                         request.nudge[p], wr_hard_verdicts[result.verdict], result.worst[p]);
        }
    }
}

static bool measures_nothing(WrHardMeasurement *gauge, WrError *err)
{
    (void)gauge, (void)err;
    return true;
}

static bool lacks_a_font(WrHardMeasurement *gauge, WrError *err)
{
    (void)gauge;
    return wr_fail(err, "no font");
}

static void a_row_that_compares_nothing_fails_and_one_that_cannot_says_why(void **state)
{
    (void)state;
    WrHardRequest request = { 0 };
    WrHardResult result;
    WrHardCase row = { .id = "HC00", .bound = { 1, NAN }, .measure = measures_nothing };
    assert_true(wr_hardcase_run(&row, &request, &result, NULL));
    assert_int_equal(result.verdict, WR_HARD_FAIL);
    assert_true(isnan(result.worst[WR_HARD_FLOAT]));
    row.measure = lacks_a_font;
    assert_true(wr_hardcase_run(&row, &request, &result, NULL));
    assert_int_equal(result.verdict, WR_HARD_UNMEASURED);
    assert_string_equal(result.note, "no font");
}

/* One thread beside three; in an ordinary run every third case. */
static void any_number_of_threads_measures_the_same(void **state)
{
    (void)state;
    const WrHardReport *three = by_three_threads();
    const WrHardRequest request = { 0 };
    for (int i = 1; i < WR_HARDCASES; i += test_step(3, 3)) {
        const WrHardResult *many = &three->results[i];
        WrHardResult one;
        WrError err;
        if (!wr_hardcase_run(wr_hardcase(i), &request, &one, &err)) fail_msg("%s", err.text);
        assert_memory_equal(one.checks, many->checks, sizeof one.checks);
        for (int p = 0; p < WR_HARD_PRECISIONS; p++)
            assert_true(one.worst[p] == many->worst[p] ||
                        (isnan(one.worst[p]) && isnan(many->worst[p])));
    }
}

static void stop_soon(void *ctx, double fraction)
{
    if (fraction > 0.05) *(int *)ctx = 1;
}

static void it_stops_when_asked_and_knows_its_instruction_sets(void **state)
{
    (void)state;
    static WrHardReport report;
    volatile int cancel = 0;
    WrProgress progress = { .cancel = &cancel, .report = stop_soon, .ctx = (void *)&cancel };
    WrHardRequest request = { .progress = &progress };
    WrError err = { "" };
    assert_false(wr_hardcases_run(&request, &report, &err));
    assert_string_equal(err.text, "cancelled");
    assert_null(report.results[0].row); /* unchanged */
    request = (WrHardRequest){ .isa = "v9" };
    assert_false(wr_hardcases_run(&request, &report, &err));
    assert_non_null(strstr(err.text, "v9"));
}

/* ---- printing ---- */

static WrHardReport *made_report(void)
{
    static WrHardReport report;
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        report.results[i] = (WrHardResult){ .row = row,
                                            .verdict = row->measure ? WR_HARD_PASS : WR_HARD_WAITS,
                                            .worst = { 1.25e-7 * i, NAN },
                                            .checks = { 10 + i, 0 },
                                            .seconds = 0.5 };
    }
    report.results[0].verdict = WR_HARD_FAIL;
    report.results[0].worst[WR_HARD_FLOAT] = INFINITY;
    report.results[1].verdict = WR_HARD_UNMEASURED;
    strcpy(report.results[1].note, "a \"font\"\nis lacking");
    report.count[WR_HARD_PASS] = 84;
    return &report;
}

static const char *text_of(json_object *at, const char *name)
{
    return json_object_get_string(json_object_object_get(at, name));
}

static void json_reads_back_as_it_was(void **state)
{
    (void)state;
    const WrHardReport *report = made_report();
    WrText text = { 0 };
    wr_hardcases_print_json(report, &text);
    json_object *all = json_tokener_parse(wr_text_get(&text));
    assert_non_null(all);
    json_object *cases = json_object_object_get(all, "cases");
    assert_int_equal(json_object_array_length(cases), WR_HARDCASES);
    assert_int_equal(json_object_get_int(json_object_object_get(all, "pass")), 84);
    for (size_t i = 0; i < WR_HARDCASES; i++) {
        json_object *at = json_object_array_get_idx(cases, i);
        const WrHardResult *r = &report->results[i];
        assert_string_equal(text_of(at, "id"), ids[i]);
        assert_string_equal(text_of(at, "holds"), r->row->holds);
        assert_string_equal(text_of(at, "verdict"), wr_hard_verdicts[r->verdict]);
        json_object *single = json_object_object_get(at, "float");
        if (i > 0 && r->row->measure && !isnan(r->row->bound[WR_HARD_FLOAT])) {
            assert_true(json_object_get_double(json_object_object_get(single, "worst")) ==
                        r->worst[WR_HARD_FLOAT]);
            assert_true(json_object_get_double(json_object_object_get(single, "bound")) ==
                        r->row->bound[WR_HARD_FLOAT]);
        }
        if (!r->row->measure) assert_null(single);
        WrText lines = { 0 };
        json_object *scene = json_object_object_get(at, "scene");
        for (size_t k = 0; k < json_object_array_length(scene); k++)
            wr_text_addf(&lines, "%s%s", k ? "\n" : "",
                         json_object_get_string(json_object_array_get_idx(scene, k)));
        assert_string_equal(wr_text_get(&lines), r->row->scene ? r->row->scene : "");
        wr_text_fini(&lines);
    }
    json_object *first = json_object_array_get_idx(cases, 0);
    assert_null(json_object_object_get(json_object_object_get(first, "float"), "worst"));
    assert_string_equal(text_of(json_object_array_get_idx(cases, 1), "note"),
                        "a \"font\"\nis lacking");
    json_object_put(all);
    wr_text_fini(&text);
}

static void the_table_has_a_line_for_each(void **state)
{
    (void)state;
    WrText text = { 0 };
    wr_hardcases_print(made_report(), &text);
    for (int i = 0; i < WR_HARDCASES; i++) {
        char start[8];
        snprintf(start, sizeof start, "\n%s ", ids[i]);
        const char *line = strstr(wr_text_get(&text), start);
        assert_non_null(line);
        assert_null(strstr(line + 1, start));
        char verdict[24];
        snprintf(verdict, sizeof verdict, " %s ",
                 wr_hard_verdicts[made_report()->results[i].verdict]);
        const char *word = strstr(line + 1, verdict);
        assert_true(word && word < strchr(line + 1, '\n'));
    }
    assert_non_null(strstr(wr_text_get(&text), "84 pass"));
    wr_text_fini(&text);
}

/* ---- the gallery ---- */

static void every_scene_can_be_built(void **state)
{
    (void)state;
    int scenes = 0, failed = 0;
    for (int i = 0; i < WR_HARDCASES; i++) {
        const char *at = wr_hardcase(i)->scene;
        if (!at) continue;
        WrSession *session = wr_session_new(NULL);
        while (*at) {
            char line[1024];
            WrError err = { "" };
            const size_t length = strcspn(at, "\n");
            snprintf(line, sizeof line, "%.*s", (int)length, at);
            if (!wr_session_run(session, line, &err)) {
                print_error("%s: %s: %s\n", ids[i], line, err.text);
                failed++;
            }
            at += length + (at[length] == '\n');
        }
        wr_session_free(session);
        scenes++;
    }
    assert_int_equal(failed, 0);
    assert_true(scenes > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_are_there_once_and_in_order),
        cmocka_unit_test(every_row_says_what_must_hold_and_is_measured_or_waits),
        cmocka_unit_test(none_fails_and_what_is_to_come_never_passes),
        cmocka_unit_test(every_measured_row_can_fail_in_every_precision),
        cmocka_unit_test(a_row_that_compares_nothing_fails_and_one_that_cannot_says_why),
        cmocka_unit_test(any_number_of_threads_measures_the_same),
        cmocka_unit_test(it_stops_when_asked_and_knows_its_instruction_sets),
        cmocka_unit_test(json_reads_back_as_it_was),
        cmocka_unit_test(the_table_has_a_line_for_each),
        cmocka_unit_test(every_scene_can_be_built),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
