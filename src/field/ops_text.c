/* Values of operations: defaults, ranges, printing and parsing. */
#include "field/ops_internal.h"

#include "base/error.h"
#include "base/text.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

/* Number of values of parameter k, which start at value[k]. */
static int numbers_of(const WrOpInfo *op, int k, const double *value)
{
    return op->params[k].points ? 1 + 2 * (int)value[k] : 1;
}

WrFilter wr_filter_of(const WrOpInfo *op)
{
    WrFilter filter = { .op = op };
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const double *points = op->params[k].points;
        filter.param[k] = points ? *points : op->params[k].fallback;
        for (int i = 1; points && i <= 2 * (int)*points; i++) filter.param[k + i] = points[i];
    }
    return filter;
}

bool wr_filter_same(const WrFilter *a, const WrFilter *b)
{
    if (a->op != b->op) return false;
    for (int k = 0; a->op && k < wr_op_param_count(a->op); k++) {
        const int count = numbers_of(a->op, k, a->param);
        if (count != numbers_of(b->op, k, b->param) ||
            memcmp(a->param + k, b->param + k, sizeof *a->param * (size_t)count) != 0)
            return false;
    }
    return true;
}

/* ---- checks ---- */

static bool check_number(const WrOpInfo *op, const WrOpParam *param, double value, WrError *err)
{
    bool inside =
        value >= param->low && value <= param->high && (!param->above || value > param->low);
    if (inside && (!param->whole || value == floor(value) || (param->share && fabs(value) < 1)))
        return true;
    if (param->choices)
        return wr_fail(err, "%s: %s %g: must be the number of one of its words, 0..%g", op->name,
                       param->name, value, param->high);
    return wr_fail(err, "%s: %s %g: must be %s%s %g..%g%s%s%s", op->name, param->name, value,
                   param->whole ? "a whole number" : "a number", param->above ? " above" : ",",
                   param->low, param->high, *param->unit ? " " : "", param->unit,
                   param->share ? ", or a share of the side between -1 and 1" : "");
}

static bool check_one(const WrOpInfo *op, const WrOpParam *param, const double *value, WrError *err)
{
    return check_number(op, param, *value, err);
}

static bool check_points(const WrOpInfo *op, const WrOpParam *param, const double *value,
                         WrError *err)
{
    if (!(*value >= 2 && *value <= WR_OP_POINTS && *value == floor(*value)))
        return wr_fail(err, "%s: %s: %g points: must be 2..%d", op->name, param->name, *value,
                       WR_OP_POINTS);
    for (int i = 1; i <= 2 * (int)*value; i++)
        if (!check_number(op, param, value[i], err)) return false;
    return true;
}

bool wr_op_check_params(const WrOpInfo *op, const double *value, WrError *err)
{
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrOpParam *param = &op->params[k];
        if (!(param->points ? check_points : check_one)(op, param, value + k, err)) return false;
    }
    return true;
}

bool wr_filter_check(const WrFilter *filter, WrError *err)
{
    const WrOpInfo *op = filter->op;
    if (op->reshapes)
        return wr_fail(err, "%s changes the table's size or edges: it cannot be a filter layer",
                       op->name);
    WrField *texel = wr_field_new(1, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    WrField *made = texel ? wr_op_run(op, texel, filter->param, NULL, err) : NULL;
    wr_field_free(texel);
    wr_field_free(made);
    return made != NULL;
}

/* ---- writing ---- */

void wr_filter_print(const WrFilter *filter, WrText *text)
{
    const WrOpInfo *op = filter->op;
    wr_text_add(text, op->name);
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrOpParam *param = &op->params[k];
        const double *value = filter->param + k;
        wr_text_addf(text, " %s=", param->name);
        if (param->choices) wr_text_add(text, param->choices[(int)*value]);
        else if (!param->points) wr_text_add_number(text, *value);
        for (int i = 1; param->points && i <= 2 * (int)*value; i++) {
            if (i > 1) wr_text_add(text, i % 2 ? ";" : ",");
            wr_text_add_number(text, value[i]);
        }
    }
}

/* ---- reading ---- */

static bool read_word(const WrOpParam *param, const char *at, size_t length, double *value)
{
    for (int i = 0; param->choices[i]; i++)
        if (strlen(param->choices[i]) == length && strncmp(param->choices[i], at, length) == 0) {
            *value = i;
            return true;
        }
    return false;
}

/* "0,0;0.5,0.25;1,1" */
static bool read_points(const char *at, size_t length, double *value)
{
    const char *end = at + length, *stop = at;
    int count = 0;
    for (; stop < end && count < 2 * WR_OP_POINTS; at = stop + 1) {
        stop = memchr(at, count % 2 ? ';' : ',', (size_t)(end - at));
        if (!stop) stop = end;
        if (!wr_number_parse(at, (size_t)(stop - at), &value[++count])) return false;
    }
    *value = count / 2;
    return count % 2 == 0 && stop == end;
}

/* "sigma=3" */
static bool read_param(const char *at, size_t length, WrFilter *filter, WrError *err)
{
    const char *sign = memchr(at, '=', length);
    const size_t name = sign ? (size_t)(sign - at) : length;
    for (int k = 0; sign && k < wr_op_param_count(filter->op); k++) {
        const WrOpParam *param = &filter->op->params[k];
        if (strlen(param->name) != name || strncmp(param->name, at, name) != 0) continue;
        const char *text = sign + 1;
        const size_t rest = length - name - 1;
        bool good = param->choices  ? read_word(param, text, rest, &filter->param[k])
                    : param->points ? read_points(text, rest, &filter->param[k])
                                    : wr_number_parse(text, rest, &filter->param[k]);
        return good || wr_fail(err, "%s: %s: '%.*s' is none of its values", filter->op->name,
                               param->name, (int)(rest < 40 ? rest : 40), text);
    }
    return wr_fail(err, "%s: has no '%.*s'", filter->op->name, (int)(length < 40 ? length : 40),
                   at);
}

bool wr_filter_parse(const char *text, WrFilter *filter, WrError *err)
{
    char name[32] = "";
    size_t length = strcspn(text, " ");
    if (length < sizeof name) memcpy(name, text, length);
    const WrOpInfo *op = wr_op_find(name);
    if (!op) return wr_fail(err, "no operation is called '%.40s'", text);
    *filter = wr_filter_of(op);
    for (text += length; *text; text += length) {
        text += strspn(text, " ");
        length = strcspn(text, " ");
        if (length > 0 && !read_param(text, length, filter, err)) return false;
    }
    return wr_filter_check(filter, err);
}
