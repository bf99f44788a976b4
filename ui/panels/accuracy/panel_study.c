/* Tour of the cost of accuracy, in the Accuracy tab: five minutes on the user's own document. Each step has a picture of the
   patch and a measured result. The document does not change; the end of the tour restores the view of the patch and side B. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/patch/preview/preview.h"

#include "accuracy/accuracy_benchmark.h"
#include "accuracy/illusion.h"
#include "accuracy/plot.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "scene/dials.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* RMS error of linear intensity that is hard to see: a step of an 8-bit picture. */
#define HARD_TO_SEE (1.0 / 255)

typedef struct Step {
    const char *title, *text;
    WrPatchLook look;
    int axis; /* B has the fastest setting of this axis; WR_AXIS_COUNT: none */
    /* Add the measured result; false: it is not measured yet. */
    bool (*result)(const WrApp *app, const struct Step *step, WrText *out);
    WrWorkKind work; /* whose progress is shown until there is a result */
} Step;

/* ---- results ---- */

/* With the language's decimal mark. */
static const char *print_number(double value, char text[16])
{
    return wr_words_number(wr_plot_number(value, text));
}

static bool picture_time(const WrApp *app, const Step *step, WrText *out)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    double stages[WR_PICTURE_STAGES];
    char text[120];
    (void)step;
    if (!picture->serial) return false;
    wr_words_print(text, sizeof text, wr_words("One picture of the patch: %.1f ms."),
                   wr_picture_time(picture, stages));
    wr_text_add(out, text);
    return true;
}

static bool error_numbers(const WrApp *app, const Step *step, WrText *out)
{
    const WrWork *e = app->accuracy->error;
    char rms[16], max[16];
    (void)step;
    if (!e || e->of != app->accuracy->state) return false;
    wr_text_addf(out, wr_words("Error: rms %s, at most %s. White is 1."),
                 print_number(e->errors.rms, rms), print_number(e->errors.max, max));
    return true;
}

static bool effects_that_ran(const WrApp *app, const Step *step, WrText *out)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    const WrPlanRow *dearest = NULL;
    int count = 0;
    (void)step;
    if (!picture->serial) return false;
    for (int i = 0; i < WR_EFFECT_COUNT; i++) {
        const WrPlanRow *row = &picture->plan.rows[i];
        count += row->run;
        if (row->run && (!dearest || row->seconds > dearest->seconds)) dearest = row;
    }
    wr_text_addf(out, wr_words("%d of %d effects run."), count, WR_EFFECT_COUNT);
    if (dearest && dearest->seconds > 0.0 && picture->plan.work > 0.0)
        wr_text_addf(out, wr_words(" The most expensive is %s, with %.0f %% of the time."),
                     wr_words(dearest->name), 100.0 * dearest->seconds / picture->plan.work);
    return true;
}

/* The fastest or the most accurate rung of an axis, or of all; none above `most` rms. -1: there is none. */
static int best(const WrAccuracyBenchmark *benchmark, int axis, bool fastest, double most)
{
    int found = -1;
    for (int i = 0; i < benchmark->count; i++) {
        const WrRung *rung = &benchmark->rungs[i], *than = &benchmark->rungs[found < 0 ? 0 : found];
        if (!wr_plot_has_point(rung) || rung->errors.rms > most) continue;
        if (axis != WR_AXIS_COUNT && (int)rung->axis != axis) continue;
        if (found < 0 ||
            (fastest ? rung->seconds < than->seconds : rung->errors.rms < than->errors.rms))
            found = i;
    }
    return found;
}

static const WrAccuracyBenchmark *benchmark_of(const WrApp *app)
{
    return wr_accuracy_plot_fits(app) ? &app->accuracy->plot->benchmark : NULL;
}

/* The dials of a setting as the panel calls them: "Scheme central, Samples 4". */
static void add_dials(const WrSetting *setting, WrText *out)
{
    for (int i = 0; i < setting->count; i++) {
        const WrDial *dial = &wr_dials[setting->dial[i]];
        const int choice = (int)setting->value[i];
        wr_text_addf(out, "%s%s ", i ? ", " : "", wr_words(dial->label));
        if (dial->choices > 0) wr_text_add(out, wr_words(dial->choice(choice)));
        else wr_text_add_number(out, setting->value[i]);
    }
}

static void add_rung(const char *name, const WrRung *rung, WrText *out)
{
    char time[16], rms[16];
    WrText dials = { 0 };
    if (rung->current) wr_text_add(&dials, wr_words("as the scene stood"));
    else add_dials(&rung->setting, &dials);
    wr_text_addf(out, wr_words("%s: %s\n%s ms, rms %s"), wr_words(name), wr_text_get(&dials),
                 print_number(1e3 * rung->seconds, time), print_number(rung->errors.rms, rms));
    wr_text_fini(&dials);
}

static bool axis_prices(const WrApp *app, const Step *step, WrText *out)
{
    const WrAccuracyBenchmark *benchmark = benchmark_of(app);
    if (!benchmark) return false;
    const int fast = best(benchmark, step->axis, true, INFINITY);
    const int exact = best(benchmark, step->axis, false, INFINITY);
    const int present = wr_accuracy_current_rung(app);
    if (present >= 0 && wr_plot_has_point(&benchmark->rungs[present])) {
        add_rung("Yours", &benchmark->rungs[present], out);
        wr_text_add(out, "\n");
    }
    if (fast < 0) wr_text_add(out, wr_words("This scene has no other choice here."));
    else
        add_rung(fast == exact ? "Fastest and most accurate of the others"
                               : "Fastest of the others",
                 &benchmark->rungs[fast], out);
    if (fast == exact) return true;
    wr_text_add(out, "\n");
    add_rung("Most accurate of the others", &benchmark->rungs[exact], out);
    return true;
}

static bool omitted_angle(const WrApp *app, const Step *step, WrText *out)
{
    const WrPatchLayer *map = &app->accuracy->map;
    char number[16];
    if (map->of != app->accuracy->state || map->look != (int)step->look) return false;
    wr_text_addf(out, wr_words("The brightest colour means %s\xc2\xb0 and more."),
                 print_number(map->full, number));
    return true;
}

static bool has_illusion(const WrAccuracy *a)
{
    return a->illusion && a->illusion->of == a->state;
}

static bool illusion_height(const WrApp *app, const Step *step, WrText *out)
{
    (void)step;
    if (!has_illusion(app->accuracy)) return false;
    wr_illusion_height(&app->accuracy->illusion->illusion, out);
    return true;
}

static int recommended(const WrAccuracyBenchmark *benchmark)
{
    return benchmark ? best(benchmark, WR_AXIS_COUNT, true, HARD_TO_SEE) : -1;
}

static bool recommendation(const WrApp *app, const Step *step, WrText *out)
{
    (void)step;
    const WrAccuracyBenchmark *benchmark = benchmark_of(app);
    if (!benchmark) return false;
    const int rung = recommended(benchmark);
    if (rung < 0) wr_text_add(out, wr_words("No setting has an error that is hard to see."));
    else add_rung("Fastest with an error that is hard to see", &benchmark->rungs[rung], out);
    return true;
}

/* ---- steps ---- */

static const Step steps[] = {
    { "The picture and its time",
      "Every approximation is a choice between time and accuracy. This tour measures them on your "
      "own document, in "
      "this view. Nothing in the document changes.",
      WR_PATCH_PLAIN, WR_AXIS_COUNT, picture_time, WR_WORK_ERROR },
    { "Where it is wrong",
      "The patch is compared with a reference: double precision, a separate renderer, many samples "
      "per pixel. The map shows the error.",
      WR_PATCH_ERROR, WR_AXIS_COUNT, error_numbers, WR_WORK_ERROR },
    { "What runs",
      "Effects that this scene does not need are left out. The colours show the effects that ran "
      "in each pixel; the Plan tab lists the reasons, the most expensive first.",
      WR_PATCH_RAN, WR_AXIS_COUNT, effects_that_ran, WR_WORK_ERROR },
    { "Slopes",
      "The bump needs slopes of the table between its texels. Left is your setting, right the "
      "fastest. Drag the line; "
      "look closely at fine relief.",
      WR_PATCH_SPLIT, WR_AXIS_DERIVATIVE, axis_prices, WR_WORK_BENCHMARK },
    { "Normals",
      "Blinn's formula tilts the normal by the slopes and omits terms that are small when F is "
      "small. Left is your setting, right the fastest.",
      WR_PATCH_SPLIT, WR_AXIS_NORMAL, axis_prices, WR_WORK_BENCHMARK },
    { "What the formula leaves out",
      "The angle between the approximate and the exact normal. It grows with the height of the "
      "bump and the curvature "
      "of the surface.",
      WR_PATCH_DROPPED, WR_AXIS_COUNT, omitted_angle, WR_WORK_ERROR },
    { "Antialiasing",
      "One sample a pixel is fast and jagged; relief finer than a pixel sparkles. Left is your "
      "setting, right the "
      "fastest.",
      WR_PATCH_SPLIT, WR_AXIS_ANTIALIASING, axis_prices, WR_WORK_BENCHMARK },
    { "Bump beside displacement",
      "Bump mapping tilts normals and moves nothing. Red: the outline differs. Green: the shading. "
      "Blue: shadows of the relief are missing.",
      WR_PATCH_LACKS, WR_AXIS_COUNT, illusion_height, WR_WORK_ILLUSION },
    { "The best for your time",
      "Each dot in the plot below is a measured setting. The line joins those that no other "
      "setting beats in both time and error.",
      WR_PATCH_PLAIN, WR_AXIS_COUNT, recommendation, WR_WORK_BENCHMARK },
};

static void go(WrApp *app, int step)
{
    WrStudy *study = &app->accuracy->study;
    study->step = step;
    study->taken = false;
    if (steps[step - 1].look == WR_PATCH_LACKS && !has_illusion(app->accuracy))
        app->accuracy->illusion_wanted = true;
    wr_accuracy_set_view(app, steps[step - 1].look);
}

void wr_act_study(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    wr_act_accuracy(app);
    if (a->study.step) return;
    a->study = (WrStudy){ .look = a->look, .b_given = a->b_given };
    memcpy(a->study.b, a->b, sizeof a->b);
    app->settings->turning = false;
    go(app, 1);
}

bool wr_is_study(const WrApp *app)
{
    return app->accuracy->study.step > 0;
}

static void end(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    memcpy(a->b, a->study.b, sizeof a->b);
    a->b_given = a->study.b_given;
    a->b_serial++;
    a->study.step = 0;
    wr_accuracy_set_view(app, a->study.look);
}

/* ---- the box at the top of the tab ---- */

/* The buttons are above the text, so that they stay under the pointer. */
static void buttons(WrApp *app)
{
    const int step = app->accuracy->study.step, count = WR_LENGTH(steps);
    char text[32];
    wr_gui_disable(step == 1);
    if (wr_gui_button("Back##study", false)) go(app, step - 1);
    wr_gui_disable_end();
    wr_gui_same_line(6);
    wr_gui_disable(step == count);
    if (wr_gui_button("Next##study", true)) go(app, step + 1);
    wr_gui_disable_end();
    wr_gui_same_line(6);
    const bool ends = wr_gui_button("End the tour", false);
    wr_gui_tip("Restores the patch and side B as before the tour");
    snprintf(text, sizeof text, wr_words("%d of %d"), step, count);
    wr_gui_same_line(10);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
    if (ends) end(app);
}

static void print_result(WrApp *app, const Step *step)
{
    WrText text = { 0 };
    double fraction = 0;
    if (step->result(app, step, &text)) {
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_STRONG, wr_text_get(&text));
    } else if (wr_accuracy_busy(app, step->work, &fraction)) {
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, "Measuring ...");
        wr_gui_progress(0, fraction);
    } else {
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, "Measured while the patch rests.");
    }
    wr_text_fini(&text);
}

void wr_panel_study(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (!a->study.step) {
        if (wr_gui_button("Tour: cost of accuracy", false)) wr_action_run(app, WR_ACT(study));
        wr_gui_tip("Nine steps, about five minutes, on this document");
        return;
    }
    buttons(app);
    if (!a->study.step) return;
    const Step *step = &steps[a->study.step - 1];
    const WrAccuracyBenchmark *benchmark = benchmark_of(app);
    if (benchmark && step->axis != WR_AXIS_COUNT && !a->study.taken) {
        const int fast = best(benchmark, step->axis, true, INFINITY);
        a->study.taken = true;
        if (fast >= 0) wr_accuracy_take_rung(app, 1, fast);
    }
    wr_gui_list_begin("study",
                      wr_gui_px(216)); /* of constant height: rows below stay where they are */
    wr_gui_text(WR_FONT_BOLD, WR_COLOUR_STRONG, step->title);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_TEXT, step->text);
    print_result(app, step);
    wr_gui_list_end();
    if (a->study.step < WR_LENGTH(steps)) return;
    const int rung = recommended(benchmark_of(app));
    wr_gui_disable(rung < 0);
    if (wr_gui_button("Use this setting", false)) wr_accuracy_take_rung(app, 0, rung);
    wr_gui_disable_end();
    wr_gui_tip("Copies these dials to the scene; undo restores the present ones");
}
