#include "surface/expression.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/enum_rows.h"
#include "base/text.h"

#include <math.h>
/* A formula is compiled to a program for a stack machine: operands first, then the operation. Evaluation
   (expression_body.h) runs it on spans of samples, with derivatives. */
#include <string.h>

/* Operands per operation: an operation replaces them by one value. */
WR_ROWS(takes);
static const unsigned char takes[] = {
    [WR_ROW(WR_OP_CONST)] = 0, [WR_ROW(WR_OP_U)] = 0,   [WR_ROW(WR_OP_V)] = 0,
    [WR_ROW(WR_OP_ADD)] = 2,   [WR_ROW(WR_OP_SUB)] = 2, [WR_ROW(WR_OP_MUL)] = 2,
    [WR_ROW(WR_OP_DIV)] = 2,   [WR_ROW(WR_OP_NEG)] = 1, [WR_ROW(WR_OP_SQRT)] = 1,
    [WR_ROW(WR_OP_SIN)] = 1,   [WR_ROW(WR_OP_COS)] = 1, [WR_ROW(WR_OP_EXP)] = 1,
    [WR_ROW(WR_OP_LOG)] = 1,   [WR_ROW(WR_OP_ABS)] = 1, [WR_ROW(WR_OP_WHOLE)] = 1,
    [WR_ROW(WR_OP_POWER)] = 1, [WR_ROW(WR_OP_POW)] = 2, [WR_ROW(WR_OP_ATAN2)] = 2,
    [WR_ROW(WR_OP_MIN)] = 2,   [WR_ROW(WR_OP_MAX)] = 2,
};
WR_ROWS_END(takes, WR_OP_COUNT);

static const struct {
    const char *name;
    WrOpCode code;
} functions[] = {
    { "sqrt", WR_OP_SQRT }, { "sin", WR_OP_SIN }, { "cos", WR_OP_COS }, { "exp", WR_OP_EXP },
    { "log", WR_OP_LOG },   { "abs", WR_OP_ABS }, { "pow", WR_OP_POW }, { "atan2", WR_OP_ATAN2 },
    { "min", WR_OP_MIN },   { "max", WR_OP_MAX },
};
#define FUNCTIONS ((int)(sizeof functions / sizeof *functions))

int wr_op_operand_count(WrOpCode code)
{
    return takes[code];
}

typedef struct Reader {
    const char *name, *text, *at;
    WrProgram *program;
    int depth, stack; /* of nesting; of values on the stack */
    WrError *err;
} Reader;

static int column_of(const Reader *r, const char *at)
{
    return (int)(at - r->text) + 1;
}

static bool wrong(const Reader *r, const char *at, const char *what)
{
    return wr_fail(r->err, "%s: column %d: %s", r->name, column_of(r, at), what);
}

static void skip_spaces(Reader *r)
{
    while (*r->at == ' ' || *r->at == '\t') r->at++;
}

static bool take(Reader *r, char letter)
{
    skip_spaces(r);
    if (*r->at != letter) return false;
    r->at++;
    return true;
}

/* Folds operations on constants. A division by 0 is left to be reported by the evaluation.
   Folding halves the work of constants such as 2*pi; it uses double, also for the float kernels.
   0 to a negative power is left to it as well, and so are functions: their errors depend on the point. */
static bool fold(WrProgram *p, WrOpCode code, double value)
{
    const int count = takes[code];
    WrOp *op = p->op + p->count - count;
    for (int i = 0; i < count; i++)
        if (op[i].code != WR_OP_CONST) return false;
    switch (code) {
    case WR_OP_ADD: op->value += op[1].value; break;
    case WR_OP_SUB: op->value -= op[1].value; break;
    case WR_OP_MUL: op->value *= op[1].value; break;
    case WR_OP_NEG: op->value = -op->value; break;
    case WR_OP_DIV:
        if (op[1].value == 0) return false;
        op->value /= op[1].value;
        break;
    case WR_OP_WHOLE:
        if (op->value == 0 && value < 0) return false;
        op->value = wr_pow(op->value, value);
        break;
    default: return false;
    }
    p->count -= count - 1;
    return true;
}

/* stack is the depth after this operation; it is checked here, so that the evaluation needs no test. */
static bool emit(Reader *r, const char *at, WrOpCode code, double value)
{
    WrProgram *p = r->program;
    r->stack += 1 - takes[code];
    if (p->count == WR_PROGRAM_OPS)
        return wrong(r, at, "is too long: must be at most 600 operations");
    if (r->stack > WR_PROGRAM_STACK)
        return wrong(r, at, "too many values wait for their operation: must be at most 24");
    if (takes[code] > 0 && fold(p, code, value)) return true;
    p->op[p->count++] = (WrOp){ code, column_of(r, at), value };
    return true;
}

/* Grammar, each level binding tighter: sum = product {+- product}; product = signed {* or / signed}; signed =
   {+-} factor; factor = value [^ signed]; value = number, name, function or (sum). So -x^2 is -(x^2), and x^-1
   and x^y^z need no brackets. */

static bool read_sum(Reader *r);
static bool read_signed(Reader *r);

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* wr_number_parse is independent of the locale; "1e" without digits is the number 1 and the name e, which is
   then an error. */
static bool read_number(Reader *r)
{
    const char *from = r->at, *end = from;
    double value;
    while (is_digit(*end) || *end == '.') end++;
    if (*end == 'e' || *end == 'E') {
        const char *sign = end + 1 + (end[1] == '+' || end[1] == '-');
        if (is_digit(*sign)) {
            end = sign;
            while (is_digit(*end)) end++;
        }
    }
    if (!wr_number_parse(from, (size_t)(end - from), &value)) return wrong(r, from, "is no number");
    r->at = end;
    return emit(r, from, WR_OP_CONST, value);
}

/* Arguments are pushed in order, so atan2(y, x) has y below x. */
static bool read_arguments(Reader *r, int wanted)
{
    if (!take(r, '(')) return wrong(r, r->at, "must be ( after a function's name");
    for (int i = 0; i < wanted; i++) {
        if (i > 0 && !take(r, ','))
            return wrong(r, r->at, "must be a comma: the function has two arguments");
        if (!read_sum(r)) return false;
    }
    return take(r, ')') || wrong(r, r->at, "must be ) or an operation");
}

static bool read_power(Reader *r, const char *at);

static bool read_name(Reader *r)
{
    const char *from = r->at;
    while (is_letter(*r->at) || is_digit(*r->at)) r->at++;
    const size_t length = (size_t)(r->at - from);
    if (length == 1 && *from == 'u') return emit(r, from, WR_OP_U, 0);
    if (length == 1 && *from == 'v') return emit(r, from, WR_OP_V, 0);
    if (length == 2 && strncmp(from, "pi", 2) == 0) return emit(r, from, WR_OP_CONST, WR_PI);
    for (int i = 0; i < FUNCTIONS; i++) {
        if (strlen(functions[i].name) != length || strncmp(functions[i].name, from, length) != 0)
            continue;
        if (!read_arguments(r, takes[functions[i].code])) return false;
        return functions[i].code == WR_OP_POW ? read_power(r, from)
                                              : emit(r, from, functions[i].code, 0);
    }
    return wrong(
        r, from,
        "is no name: must be u, v, pi, sqrt, sin, cos, exp, log, abs, pow, atan2, min or max");
}

/* A value begins with a digit, a letter or (: one letter decides, so nothing is read twice. */
static bool read_value(Reader *r)
{
    skip_spaces(r);
    if (is_digit(*r->at) || *r->at == '.') return read_number(r);
    if (is_letter(*r->at)) return read_name(r);
    if (!take(r, '('))
        return wrong(r, r->at,
                     *r->at ? "must be a number, a name or ("
                            : "ends early: must be a number, a name or (");
    return read_sum(r) && (take(r, ')') || wrong(r, r->at, "must be ) or an operation"));
}

/* The power of the top two values; a constant exponent becomes part of the operation.
   Whole exponents are products and valid for negative bases; other constants need a positive base
   (NUMERICS-SCENES c). */
static bool read_power(Reader *r, const char *at)
{
    WrProgram *p = r->program;
    const WrOp *top = &p->op[p->count - 1];
    if (top->code != WR_OP_CONST) return emit(r, at, WR_OP_POW, 0);
    const double exponent = top->value;
    p->count--;
    r->stack--;
    const bool whole = exponent == rint(exponent) && fabs(exponent) <= WR_POWER_WHOLE;
    return emit(r, at, whole ? WR_OP_WHOLE : WR_OP_POWER, exponent);
}

/* The exponent is read as `signed`, which reads a factor in turn: ^ is right-associative. */
static bool read_factor(Reader *r)
{
    if (!read_value(r)) return false;
    skip_spaces(r);
    const char *at = r->at;
    if (!take(r, '^')) return true;
    return read_signed(r) && read_power(r, at);
}

/* All recursion passes through here: one depth limit protects the stack (HC150). */
static bool read_signed(Reader *r)
{
    skip_spaces(r);
    const char *at = r->at;
    if (++r->depth > WR_EXPRESSION_DEPTH)
        return wrong(r, at, "is nested too deep: must be at most 50 levels");
    bool good;
    if (take(r, '-')) good = read_signed(r) && emit(r, at, WR_OP_NEG, 0);
    else if (take(r, '+')) good = read_signed(r);
    else good = read_factor(r);
    r->depth--;
    return good;
}

/* Left-associative: each operation is emitted as soon as its right operand is. */
static bool read_product(Reader *r)
{
    if (!read_signed(r)) return false;
    for (;;) {
        skip_spaces(r);
        const char *at = r->at;
        const WrOpCode code = *at == '/' ? WR_OP_DIV : WR_OP_MUL;
        if (!take(r, '*') && !take(r, '/')) return true;
        if (!read_signed(r) || !emit(r, at, code, 0)) return false;
    }
}

static bool read_sum(Reader *r)
{
    if (!read_product(r)) return false;
    for (;;) {
        skip_spaces(r);
        const char *at = r->at;
        const WrOpCode code = *at == '-' ? WR_OP_SUB : WR_OP_ADD;
        if (!take(r, '+') && !take(r, '-')) return true;
        if (!read_product(r) || !emit(r, at, code, 0)) return false;
    }
}

bool wr_expression_read(const char *name, const char *text, WrProgram *program, WrError *err)
{
    Reader r = { .name = name, .text = text, .at = text, .program = program, .err = err };
    if (!read_sum(&r)) return false;
    skip_spaces(&r);
    return *r.at == '\0' || wrong(&r, r.at, "must be an operation, or the end");
}
