/* Report of the hard cases as text and as JSON. */
#include "hardcases/hardcases.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

static void add_value(WrText *text, double value)
{
    if (isnan(value)) wr_text_addf(text, " %9s", "-");
    else if (value == floor(value) && fabs(value) < 1e6) wr_text_addf(text, " %9.0f", value);
    else wr_text_addf(text, " %9.2g", value);
}

void wr_hardcases_print(const WrHardReport *report, WrText *text)
{
    wr_text_addf(text, "%-5s %9s %9s %9s %9s  %-22s %-10s %s\n", "id", "float", "at most", "double",
                 "at most", "unit", "", "what must hold");
    int subject = -1;
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *r = &report->results[i];
        if ((int)r->row->subject != subject) {
            subject = (int)r->row->subject;
            wr_text_addf(text, "\n%s\n", wr_hard_subjects[subject]);
        }
        wr_text_addf(text, "%-5s", r->row->id);
        for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
            add_value(text, r->worst[p]);
            add_value(text, r->row->measure ? r->row->bound[p] : NAN);
        }
        wr_text_addf(text, "  %-22s %-10s %s: %s", r->row->measure ? r->row->unit : "-",
                     wr_hard_verdicts[r->verdict], r->row->what, r->row->holds);
        if (r->row->waits)
            wr_text_addf(text, r->row->measure ? "; still to come: %s" : "; waits for %s",
                         r->row->waits);
        if (r->note[0]) wr_text_addf(text, "; %s", r->note);
        wr_text_add(text, "\n");
    }
    wr_text_addf(text,
                 "\n%d pass, %d fail, %d wait for what is still to come, %d could not be"
                 " measured here; %.1f s\n",
                 report->count[WR_HARD_PASS], report->count[WR_HARD_FAIL],
                 report->count[WR_HARD_WAITS], report->count[WR_HARD_UNMEASURED], report->seconds);
}

static void add_member(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (value && *value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static void add_precision(WrText *text, const char *name, const WrHardResult *r,
                          WrHardPrecision precision)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (!r->row->measure || isnan(r->row->bound[precision])) {
        wr_text_add(text, "null");
        return;
    }
    wr_text_add(text, "{\"worst\":");
    wr_text_add_json_number(text, r->worst[precision]);
    wr_text_add(text, ",\"bound\":");
    wr_text_add_json_number(text, r->row->bound[precision]);
    wr_text_addf(text, ",\"checks\":%lld}", (long long)r->checks[precision]);
}

static void add_lines(WrText *text, const char *lines)
{
    wr_text_add(text, ",\"scene\":[");
    for (const char *at = lines; at && *at;) {
        const size_t length = strcspn(at, "\n");
        WrText line = { 0 };
        wr_text_add_n(&line, at, length);
        if (at != lines) wr_text_add(text, ",");
        wr_text_add_json_string(text, wr_text_get(&line));
        wr_text_fini(&line);
        at += length + (at[length] == '\n');
    }
    wr_text_add(text, "]");
}

void wr_hardcases_print_json(const WrHardReport *report, WrText *text)
{
    wr_text_add(text, "{\"cases\":[");
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *r = &report->results[i];
        wr_text_addf(text, "%s\n{\"id\":\"%s\"", i ? "," : "", r->row->id);
        add_member(text, "subject", wr_hard_subjects[r->row->subject]);
        add_member(text, "what", r->row->what);
        add_member(text, "holds", r->row->holds);
        add_member(text, "unit", r->row->unit);
        add_precision(text, "float", r, WR_HARD_FLOAT);
        add_precision(text, "double", r, WR_HARD_DOUBLE);
        add_member(text, "verdict", wr_hard_verdicts[r->verdict]);
        add_member(text, "waits", r->row->waits);
        add_member(text, "note", r->note);
        wr_text_add(text, ",\"seconds\":");
        wr_text_add_json_number(text, r->seconds);
        add_lines(text, r->row->scene);
        wr_text_add(text, "}");
    }
    wr_text_addf(text, "],\n\"pass\":%d,\"fail\":%d,\"waits\":%d,\"unmeasured\":%d,\"seconds\":",
                 report->count[WR_HARD_PASS], report->count[WR_HARD_FAIL],
                 report->count[WR_HARD_WAITS], report->count[WR_HARD_UNMEASURED]);
    wr_text_add_json_number(text, report->seconds);
    wr_text_add(text, "}\n");
}
