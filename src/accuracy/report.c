/* Output of a benchmark as a table, as CSV and as JSON. */
#include "accuracy/report.h"

#include <math.h>

/* ---- text ---- */

static void add_error(WrText *text, double x)
{
    if (isnan(x)) wr_text_addf(text, " %9s", "-");
    else if (x == 0) wr_text_addf(text, " %9s", "0");
    else wr_text_addf(text, " %9.2e", x);
}

static void add_heading(WrText *text, const char *title)
{
    wr_text_addf(text, "\n%-50s %9s %7s %6s %9s %9s %9s %9s %9s %9s\n", title, "ms", "+-", "ns/px",
                 "rms", "own rms", "99.9 %", "max", "angle", "coverage");
}

static void add_rung(const WrAccuracyBenchmark *benchmark, const WrRung *rung, WrText *text)
{
    WrText setting = { 0 };
    wr_setting_print(&rung->setting, &setting);
    wr_text_addf(text, "%c %-48s", rung->front ? '*' : ' ', wr_text_get(&setting));
    wr_text_fini(&setting);
    if (rung->note.text[0]) {
        wr_text_addf(text, " %s\n", rung->note.text);
        return;
    }
    /* ns/px is time per covered pixel, so that scenes of different coverage compare. */
    const double pixels = (double)benchmark->width * benchmark->height;
    const double covered = rung->errors.covered > 0 ? (double)rung->errors.covered : pixels;
    wr_text_addf(text, " %9.3f %7.3f %6.1f", 1e3 * rung->seconds, 1e3 * rung->spread,
                 1e9 * rung->seconds / covered);
    if (rung->model) {
        wr_text_add(text, "  another model, not an approximation of this one\n");
        return;
    }
    add_error(text, rung->errors.rms);
    add_error(text, rung->own_rms);
    add_error(text, rung->errors.p999);
    add_error(text, rung->errors.max);
    add_error(text, rung->errors.angle_rms);
    add_error(text, rung->errors.coverage_rms);
    wr_text_add(text, "\n");
}

static void add_axis(const WrAccuracyBenchmark *benchmark, int axis, const char *title,
                     WrText *text)
{
    bool any = false;
    for (int i = 0; i < benchmark->count; i++) {
        if ((int)benchmark->rungs[i].axis != axis) continue;
        if (!any) add_heading(text, title);
        any = true;
        add_rung(benchmark, &benchmark->rungs[i], text);
    }
}

static void add_reference(const WrAccuracyBenchmark *benchmark, WrText *text)
{
    const WrReference *reference = &benchmark->reference;
    wr_text_addf(
        text,
        "\nreference: double precision, %d x %d samples a pixel, the last doubling changed "
        "%.1e (rms), %.1e (max): %s\n",
        reference->samples, reference->samples, reference->last_rms, reference->last_max,
        reference->converged
            ? "under a tenth of the smallest error above"
            : "NOT under a tenth of the smallest error above; errors of that size are its "
              "own");
    if (reference->lost > 0)
        wr_text_addf(text, "reference: %lld samples took the nearest root that it found\n",
                     (long long)reference->lost);
}

static void add_faults(const WrAccuracyBenchmark *benchmark, WrText *text)
{
    for (int i = 0; i < benchmark->count; i++) {
        if (!benchmark->rungs[i].fault) continue;
        wr_text_add(text, "a fault of the program: ");
        wr_accuracy_benchmark_fault_print(&benchmark->rungs[i], text);
        wr_text_add(text, ", though it should be nearer; please report it with this document\n");
    }
}

/* Both ratios are those that Blinn (1978) states; the measured ones are those of this scene. */
static void add_claim(const WrAccuracyBenchmark *benchmark, WrText *text)
{
    wr_text_addf(
        text,
        "the paper: bump costs about 4 times Phong and 2 times a colour picture; here %.2f and "
        "%.2f\n",
        benchmark->blinn_phong, benchmark->blinn_colour);
}

void wr_report_text(const WrAccuracyBenchmark *benchmark, const char *name, WrText *text)
{
    wr_text_addf(text,
                 "%s%s%d x %d pixels, %d %s; * is on the front: nothing is both faster and "
                 "nearer\n",
                 name, name[0] ? ", " : "", benchmark->width, benchmark->height, benchmark->threads,
                 benchmark->threads == 1 ? "thread" : "threads");
    for (int axis = 0; axis < WR_AXIS_COUNT; axis++)
        add_axis(benchmark, axis, wr_axis_labels[axis], text);
    add_axis(benchmark, WR_AXIS_COUNT, "as it stands, and combinations", text);
    add_reference(benchmark, text);
    add_claim(benchmark, text);
    add_faults(benchmark, text);
}

/* ---- numbers of a rung, for CSV and JSON ---- */

/* NaN stands for numbers that do not exist: an empty field in CSV, null in JSON. placed: errors against the
   reference are defined. */

typedef struct Number {
    const char *name;
    double value;
} Number;

#define NUMBERS 16

static int numbers_of(const WrRung *rung, Number out[NUMBERS])
{
    const WrErrors *e = &rung->errors;
    const bool measured = !rung->note.text[0], placed = measured && !rung->model;
    int n = 0;
    out[n++] = (Number){ "seconds", measured ? rung->seconds : NAN };
    out[n++] = (Number){ "spread", measured ? rung->spread : NAN };
    out[n++] = (Number){ "runs", measured ? rung->runs : NAN };
    out[n++] = (Number){ "samples", measured ? (double)rung->shaded : NAN };
    out[n++] = (Number){ "rms", placed ? e->rms : NAN };
    out[n++] = (Number){ "own_rms", placed ? rung->own_rms : NAN };
    out[n++] = (Number){ "rms_all", placed ? e->rms_all : NAN };
    out[n++] = (Number){ "p999", placed ? e->p999 : NAN };
    out[n++] = (Number){ "max", placed ? e->max : NAN };
    out[n++] = (Number){ "angle_rms_deg", placed ? e->angle_rms : NAN };
    out[n++] = (Number){ "angle_p999_deg", placed ? e->angle_p999 : NAN };
    out[n++] = (Number){ "angle_max_deg", placed ? e->angle_max : NAN };
    out[n++] = (Number){ "coverage_rms", placed ? e->coverage_rms : NAN };
    out[n++] = (Number){ "coverage_max", placed ? e->coverage_max : NAN };
    return n;
}

static const char *axis_name(const WrRung *rung)
{
    return rung->axis == WR_AXIS_COUNT ? rung->current ? "as it stands" : "combination"
                                       : wr_axis_labels[rung->axis];
}

/* ---- CSV ---- */

/* RFC 4180: lines end with CR LF, quotes are doubled. */

static void add_csv_string(WrText *text, const char *bytes)
{
    wr_text_add(text, "\"");
    for (; *bytes; bytes++) {
        if (*bytes == '"') wr_text_add(text, "\"");
        wr_text_add_n(text, bytes, 1);
    }
    wr_text_add(text, "\"");
}

void wr_report_csv(const WrAccuracyBenchmark *benchmark, WrText *text)
{
    Number numbers[NUMBERS];
    WrText setting = { 0 };
    wr_text_add(text, "axis,setting,front,model,note");
    const WrRung none = { 0 };
    const int count = numbers_of(&none, numbers);
    for (int n = 0; n < count; n++) wr_text_addf(text, ",%s", numbers[n].name);
    wr_text_add(text, "\r\n");
    for (int i = 0; i < benchmark->count; i++) {
        const WrRung *rung = &benchmark->rungs[i];
        wr_text_clear(&setting);
        wr_setting_print(&rung->setting, &setting);
        add_csv_string(text, axis_name(rung));
        wr_text_add(text, ",");
        add_csv_string(text, wr_text_get(&setting));
        wr_text_addf(text, ",%d,%d,", rung->front, rung->model);
        add_csv_string(text, rung->note.text);
        numbers_of(rung, numbers);
        for (int n = 0; n < count; n++) {
            wr_text_add(text, ",");
            if (!isnan(numbers[n].value)) wr_text_add_number(text, numbers[n].value);
        }
        wr_text_add(text, "\r\n");
    }
    wr_text_fini(&setting);
}

/* ---- JSON ---- */

static void add_json_rung(const WrRung *rung, WrText *text)
{
    Number numbers[NUMBERS];
    WrText setting = { 0 };
    wr_setting_print(&rung->setting, &setting);
    wr_text_add(text, "{\"axis\":");
    wr_text_add_json_string(text, axis_name(rung));
    wr_text_add(text, ",\"setting\":");
    wr_text_add_json_string(text, wr_text_get(&setting));
    wr_text_add(text, ",\"full\":");
    wr_text_add_json_string(text, rung->full);
    wr_text_addf(text, ",\"front\":%s,\"model\":%s", rung->front ? "true" : "false",
                 rung->model ? "true" : "false");
    if (rung->note.text[0]) {
        wr_text_add(text, ",\"note\":");
        wr_text_add_json_string(text, rung->note.text);
    }
    if (rung->fault) {
        wr_text_clear(&setting);
        wr_accuracy_benchmark_fault_print(rung, &setting);
        wr_text_add(text, ",\"fault\":");
        wr_text_add_json_string(text, wr_text_get(&setting));
    }
    const int count = numbers_of(rung, numbers);
    for (int n = 0; n < count; n++) {
        wr_text_addf(text, ",\"%s\":", numbers[n].name);
        wr_text_add_json_number(text, numbers[n].value);
    }
    wr_text_add(text, "}");
    wr_text_fini(&setting);
}

void wr_report_json(const WrAccuracyBenchmark *benchmark, const char *name, WrText *text)
{
    const WrReference *reference = &benchmark->reference;
    wr_text_add(text, "{\"document\":");
    wr_text_add_json_string(text, name);
    wr_text_addf(text, ",\"width\":%d,\"height\":%d,\"threads\":%d,\"reference\":{\"samples\":%d",
                 benchmark->width, benchmark->height, benchmark->threads, reference->samples);
    wr_text_add(text, ",\"last_rms\":");
    wr_text_add_json_number(text, reference->last_rms);
    wr_text_add(text, ",\"last_max\":");
    wr_text_add_json_number(text, reference->last_max);
    wr_text_addf(text, ",\"converged\":%s,\"lost\":%lld},\"claim\":{\"bump_over_phong\":",
                 reference->converged ? "true" : "false", (long long)reference->lost);
    wr_text_add_json_number(text, benchmark->blinn_phong);
    wr_text_add(text, ",\"bump_over_colour\":");
    wr_text_add_json_number(text, benchmark->blinn_colour);
    wr_text_add(text, "},\"rungs\":[");
    for (int i = 0; i < benchmark->count; i++) {
        if (i > 0) wr_text_add(text, ",\n");
        add_json_rung(&benchmark->rungs[i], text);
    }
    wr_text_add(text, "]}\n");
}
