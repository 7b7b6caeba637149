/* The FMUs of the hoist through the functions of FMI 3.0: every wrong call, then a run in closed loop that is saved and
 * restored half-way. Arguments: of controller and plant the library, the token, and the variables with their starts. */
#include <dlfcn.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { OK = 0, ERROR = 3 };
enum { TICKS = 30000, SAVED = 10000, RESTORED = 15000 };
#define STEP 1e-4

#define REQUIRE(condition) \
    do { if (!(condition)) { fprintf(stderr, "line %d: %s; %s\n", __LINE__, #condition, message); exit(1); } } while (0)

static char message[512];

static void log_message(void *environment, int status, const char *category, const char *text)
{
    (void)environment;
    snprintf(message, sizeof message, "%d %s %s", status, category, text);
}

/* Counted, for the libraries that are loaded too: glibc's own are below. */
static long allocations;
void *__libc_malloc(size_t size);
void *malloc(size_t size) { allocations++; return __libc_malloc(size); }

/* fmi3FunctionTypes.h, as far as it is called here. */
typedef struct {
    const char *token;
    void *(*instantiate)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t,
                         void *, void (*)(void *, int, const char *, const char *), void *);
    void *(*exchange)(const char *, const char *, const char *, bool, bool, void *,
                      void (*)(void *, int, const char *, const char *));
    void (*free_instance)(void *);
    const char *(*version)(void);
    int (*enter)(void *, bool, double, double, bool, double);
    int (*leave)(void *), (*terminate)(void *), (*reset)(void *), (*event_mode)(void *);
    int (*get)(void *, const uint32_t *, size_t, double *, size_t);
    int (*set)(void *, const uint32_t *, size_t, const double *, size_t);
    int (*get_uint)(void *, const uint32_t *, size_t, uint32_t *, size_t);
    int (*get_bool)(void *, const uint32_t *, size_t, bool *, size_t);
    int (*set_bool)(void *, const uint32_t *, size_t, const bool *, size_t);
    int (*get_string)(void *, const uint32_t *, size_t, const char **, size_t);
    int (*step)(void *, double, double, bool, bool *, bool *, bool *, double *);
    int (*save)(void *, void **), (*restore)(void *, void *), (*free_state)(void *, void **);
    int (*state_size)(void *, void *, size_t *);
    int (*serialize)(void *, void *, uint8_t *, size_t), (*deserialize)(void *, const uint8_t *, size_t, void **);
} fmu;

static fmu load(const char *path, const char *token)
{
    fmu f = { .token = token };
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); exit(1); }
    const struct { const char *name; void *to; } functions[] = {
        { "fmi3InstantiateCoSimulation", &f.instantiate },   { "fmi3InstantiateModelExchange", &f.exchange },
        { "fmi3FreeInstance", &f.free_instance },            { "fmi3GetVersion", &f.version },
        { "fmi3EnterInitializationMode", &f.enter },         { "fmi3ExitInitializationMode", &f.leave },
        { "fmi3Terminate", &f.terminate },                   { "fmi3Reset", &f.reset },
        { "fmi3EnterEventMode", &f.event_mode },             { "fmi3GetFloat64", &f.get },
        { "fmi3SetFloat64", &f.set },                        { "fmi3GetUInt32", &f.get_uint },
        { "fmi3GetBoolean", &f.get_bool },                   { "fmi3SetBoolean", &f.set_bool },
        { "fmi3GetString", &f.get_string },                  { "fmi3DoStep", &f.step },
        { "fmi3GetFMUState", &f.save },                      { "fmi3SetFMUState", &f.restore },
        { "fmi3FreeFMUState", &f.free_state },               { "fmi3SerializedFMUStateSize", &f.state_size },
        { "fmi3SerializeFMUState", &f.serialize },           { "fmi3DeserializeFMUState", &f.deserialize },
    };
    for (size_t at = 0; at < sizeof functions / sizeof *functions; at++) {
        void *found = dlsym(library, functions[at].name);
        REQUIRE(found);
        memcpy(functions[at].to, &found, sizeof found);
    }
    REQUIRE(strcmp(f.version(), "3.0") == 0);
    return f;
}

static void *instance(const fmu *f)
{
    void *made = f->instantiate("one", f->token, NULL, false, false, false, false, NULL, 0, NULL, log_message, NULL);
    REQUIRE(made);
    return made;
}

static void *started(const fmu *f)
{
    void *made = instance(f);
    REQUIRE(f->enter(made, false, 0, 0, false, 0) == OK && f->leave(made) == OK);
    return made;
}

static int set(const fmu *f, void *of, uint32_t variable, double value) { return f->set(of, &variable, 1, &value, 1); }

static double get(const fmu *f, void *of, uint32_t variable)
{
    double value;
    REQUIRE(f->get(of, &variable, 1, &value, 1) == OK);
    return value;
}

static int step(const fmu *f, void *of, double time, double size)
{
    bool event = true, terminate = true, early = true;
    double reached = -1;
    int status = f->step(of, time, size, true, &event, &terminate, &early, &reached);
    /* times below 10 s are rounded by less */
    REQUIRE(status != OK || (!event && !terminate && !early && fabs(reached - (time + size)) < 1e-14));
    return status;
}

static uint32_t faults(const fmu *f, void *of)
{
    uint32_t variable = 15, value;
    REQUIRE(f->get_uint(of, &variable, 1, &value, 1) == OK);
    return value;
}

#define REFUSED(call, text) \
    do { *message = 0; REQUIRE((call) == ERROR); REQUIRE(strstr(message, text)); \
         REQUIRE(strncmp(message, "3 logStatusError ", 17) == 0); } while (0)

/* The variables of the model description are there and start as it says. */
static void starts(const fmu *f, const char *path)
{
    void *one = instance(f);
    FILE *file = fopen(path, "r");
    unsigned variable, count = 0;
    double start;
    REQUIRE(file && f->enter(one, false, 0, 0, false, 0) == OK);
    for (; fscanf(file, "%u %lf", &variable, &start) == 2; count++) {
        double value = get(f, one, variable);
        REQUIRE(isfinite(value) && (isnan(start) || value == start));
    }
    REQUIRE(count > 10 && feof(file));
    fclose(file);
    f->free_instance(one);
}

static void wrong_calls(const fmu *c, const fmu *p)
{
    const fmu *both[] = { c, p };
    uint32_t variable = 15, unknown = 99;
    double value = 0;
    bool flag;
    const char *text;
    for (int at = 0; at < 2; at++) {
        const fmu *f = both[at];
        *message = 0;
        REQUIRE(!f->instantiate("one", both[1 - at]->token, NULL, 0, 0, 0, 0, NULL, 0, NULL, log_message, NULL));
        REQUIRE(strstr(message, "token"));
        REQUIRE(!f->instantiate("one", NULL, NULL, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL));
        *message = 0;
        REQUIRE(!f->exchange("one", f->token, NULL, 0, 0, NULL, log_message) && strstr(message, "co-simulation"));
        void *one = instance(f);
        REFUSED(step(f, one, 0, STEP), "not allowed");
        REFUSED(f->leave(one), "not allowed");
        REFUSED(f->enter(one, false, 0, NAN, false, 0), "start time is NaN");
        REQUIRE(f->enter(one, false, 0, 0, false, 0) == OK && f->leave(one) == OK);
        REFUSED(f->enter(one, false, 0, 0, false, 0), "not allowed");
        REFUSED(step(f, one, STEP, STEP), "expected 0 s");
        REFUSED(step(f, one, NAN, STEP), "expected 0 s");
        const double never[] = { 0, -STEP, NAN, INFINITY };
        for (int size = 0; size < 4; size++) REFUSED(step(f, one, 0, never[size]), "expected a finite time above zero");
        REFUSED(step(f, one, 0, 1e6), "expected at most");
        REFUSED(f->event_mode(one), "not supported");
        REFUSED(f->get(one, &unknown, 1, &value, 1), "no variable 99");
        REFUSED(f->get(one, &unknown, 1, &value, 2), "2 values for 1");
        REFUSED(f->get_string(one, &unknown, 1, &text, 1), "no variable 99");
        REQUIRE(f->get_string(one, NULL, 0, NULL, 0) == OK);
        REFUSED(set(f, one, 10, 0), "can be set");
        REQUIRE(step(f, one, 0, STEP) == OK && f->terminate(one) == OK);
        REFUSED(step(f, one, STEP, STEP), "not allowed");
        REQUIRE(f->reset(one) == OK && f->enter(one, false, 0, 7, false, 0) == OK && f->leave(one) == OK);
        REQUIRE(step(f, one, 7, STEP) == OK);
        f->free_instance(one);
        REQUIRE(f->step(NULL, 0, STEP, true, NULL, NULL, NULL, NULL) == ERROR);
        f->free_instance(NULL);
    }

    void *one = started(c);
    REFUSED(step(c, one, 0, 1.5 * STEP), "expected a multiple of the sample time 0.0001 s");
    REFUSED(step(c, one, 0, 0.5 * STEP), "multiple");
    REFUSED(set(c, one, 64, 1), "can be set");
    REFUSED(c->get_bool(one, &unknown, 1, &flag, 1), "no variable 99");
    /* a step of three ticks has one angle: the others are without */
    REQUIRE(step(c, one, 0, STEP) == OK && faults(c, one) == 0);
    REQUIRE(step(c, one, STEP, 3 * STEP) == OK && faults(c, one) == 1u << 24);
    /* a fault of the first tick is one of the step: half a turn within a tick (2^2) */
    REQUIRE(set(c, one, 1, 3) == OK && step(c, one, 4 * STEP, 3 * STEP) == OK);
    REQUIRE(faults(c, one) == (1u << 24 | 1u << 2));
    REQUIRE(c->reset(one) == OK && c->enter(one, false, 0, 4 * STEP, false, 0) == OK && c->leave(one) == OK);
    /* values that cannot be true are flagged, as fault.rs has the bits */
    REQUIRE(set(c, one, 1, NAN) == OK && step(c, one, 4 * STEP, STEP) == OK && faults(c, one) == 1u << 24);
    variable = 32 + 24;
    REQUIRE(c->get_bool(one, &variable, 1, &flag, 1) == OK && flag);
    REQUIRE(set(c, one, 1, 0) == OK && set(c, one, 2, NAN) == OK && set(c, one, 3, INFINITY) == OK);
    REQUIRE(step(c, one, 5 * STEP, STEP) == OK && faults(c, one) == (1u << 5 | 1u << 1));
    /* against the brake: the holding torque, whatever the setpoint */
    variable = 5;
    flag = true;
    REQUIRE(c->set_bool(one, &variable, 1, &flag, 1) == OK && set(c, one, 4, 12) == OK);
    REQUIRE(step(c, one, 6 * STEP, STEP) == OK && get(c, one, 10) == 12);
    REQUIRE(c->reset(one) == OK && c->enter(one, false, 0, 0, false, 0) == OK && c->leave(one) == OK);
    /* a tick that does not run leaves the torque as it is; the one behind it is told (2^30) */
    REQUIRE(set(c, one, 3, 10) == OK && step(c, one, 0, STEP) == OK && faults(c, one) == 0);
    double before = get(c, one, 10);
    variable = 6;
    REQUIRE(c->set_bool(one, &variable, 1, &flag, 1) == OK && step(c, one, STEP, STEP) == OK);
    REQUIRE(get(c, one, 10) == before && faults(c, one) == 0);
    flag = false;
    REQUIRE(c->set_bool(one, &variable, 1, &flag, 1) == OK && step(c, one, 2 * STEP, STEP) == OK);
    REQUIRE(faults(c, one) == 1u << 30 && step(c, one, 3 * STEP, STEP) == OK && faults(c, one) == 0);
    REQUIRE(c->reset(one) == OK && c->enter(one, false, 0, 0, false, 0) == OK && set(c, one, 1, NAN) == OK);
    REFUSED(c->leave(one), "expected a finite angle");
    c->free_instance(one);

    one = started(p);
    REQUIRE(set(p, one, 1, NAN) == OK);
    REFUSED(step(p, one, 0, STEP), "motor_torque is NaN");
    REQUIRE(set(p, one, 1, 0) == OK && set(p, one, 2, INFINITY) == OK);
    REFUSED(step(p, one, 0, STEP), "load_torque is inf");
    REQUIRE(set(p, one, 2, -1.7e308) == OK);
    REFUSED(step(p, one, 0, STEP), "expected a torque of at most 1e12 N m");
    REFUSED(set(p, one, 200, 1), "can be set now");
    /* any step goes */
    REQUIRE(set(p, one, 2, 0) == OK && step(p, one, 0, 0.3 * STEP) == OK && step(p, one, 0.3 * STEP, 7 * STEP) == OK);
    p->free_instance(one);
    one = instance(p);
    REQUIRE(set(p, one, 200, -1) == OK && p->enter(one, false, 0, 0, false, 0) == OK);
    REFUSED(p->leave(one), "inertia[1] is -1.0, expected 1e-12 to 1e12");
    REQUIRE(set(p, one, 200, 1) == OK && set(p, one, 501, NAN) == OK);
    REFUSED(p->leave(one), "gap[2] is NaN, expected 0 or");
    REQUIRE(set(p, one, 501, 0) == OK && set(p, one, 202, 1e-300) == OK);
    REFUSED(p->leave(one), "inertia[3] is 1e-300,");
    REQUIRE(set(p, one, 202, 1) == OK && set(p, one, 300, 0) == OK);
    REFUSED(p->leave(one), "stiffness[1] is 0.0, expected 1e-12 to 1e12");
    REQUIRE(set(p, one, 300, 1) == OK && p->leave(one) == OK);
    p->free_instance(one);
    /* the values before a refused one are set, and the start follows from them */
    one = instance(p);
    const uint32_t load_and_none[] = { 2, 99 };
    const double torques[] = { 10, 0 };
    REQUIRE(p->enter(one, false, 0, 0, false, 0) == OK && get(p, one, 100) != 10);
    REFUSED(p->set(one, load_and_none, 2, torques, 2), "no variable 99");
    REQUIRE(fabs(get(p, one, 100) - 10) < 1e-9);
    p->free_instance(one);
    /* the lightest mass at the largest torque: it moves on, or is refused, and the getters give numbers */
    one = instance(p);
    REQUIRE(set(p, one, 202, 1e-12) == OK && p->enter(one, false, 0, 0, false, 0) == OK && p->leave(one) == OK);
    REQUIRE(set(p, one, 1, 1e12) == OK && set(p, one, 2, -1e12) == OK);
    for (int at = 0; at < 100; at++) {
        const uint32_t states[] = { 10, 11, 12, 13, 14, 100, 101 };
        double values[7];
        if (step(p, one, at * 1e-9, 1e-9) != OK) break;
        REQUIRE(p->get(one, states, 7, values, 7) == OK);
        for (int each = 0; each < 7; each++) REQUIRE(isfinite(values[each]));
    }
    p->free_instance(one);
}

typedef struct { double controller[5], faults, plant[7]; } row;
static row rows[TICKS];

/* A tick of the loop: the controller first, with what the plant has; then the plant. */
static void tick(const fmu *c, void *controller, const fmu *p, void *plant, int at)
{
    const uint32_t from[] = { 11, 14 }, to[] = { 1, 2, 3 }, estimates[] = { 10, 11, 12, 13, 14 };
    const uint32_t torques[] = { 1, 2 }, states[] = { 10, 11, 12, 13, 14, 100, 101 };
    double in[3], out[2];
    REQUIRE(p->get(plant, from, 2, in, 2) == OK);
    in[2] = at < 25000 ? 100 : 60;
    REQUIRE(c->set(controller, to, 3, in, 3) == OK);
    long before = allocations;
    REQUIRE(c->step(controller, at * STEP, STEP, true, NULL, NULL, NULL, NULL) == OK);
    REQUIRE(allocations == before);
    REQUIRE(c->get(controller, estimates, 5, rows[at].controller, 5) == OK);
    rows[at].faults = faults(c, controller);
    out[0] = rows[at].controller[0];
    out[1] = at < 20000 ? 747.0 : 1000.0;
    REQUIRE(p->set(plant, torques, 2, out, 2) == OK);
    REQUIRE(p->step(plant, at * STEP, STEP, true, NULL, NULL, NULL, NULL) == OK);
    REQUIRE(p->get(plant, states, 7, rows[at].plant, 7) == OK);
}

int main(int count, char **arguments)
{
    REQUIRE(count == 7);
    const fmu c = load(arguments[1], arguments[2]), p = load(arguments[4], arguments[5]);
    starts(&c, arguments[3]);
    starts(&p, arguments[6]);
    wrong_calls(&c, &p);

    void *controller = started(&c), *plant = started(&p), *other = started(&c), *saved[2] = { NULL, NULL };
    for (int at = 0; at < SAVED; at++) tick(&c, controller, &p, plant, at);
    size_t size;
    REQUIRE(c.save(controller, &saved[0]) == OK && p.save(plant, &saved[1]) == OK);
    REQUIRE(c.state_size(controller, saved[0], &size) == OK && size > 40 && size < 1000);
    uint8_t bytes[1000];
    REFUSED(c.serialize(controller, saved[0], bytes, size - 1), "bytes");
    REQUIRE(c.serialize(controller, saved[0], bytes, size) == OK && c.free_state(controller, &saved[0]) == OK);
    REQUIRE(!saved[0]);
    REFUSED(p.serialize(plant, saved[1], bytes, size), "not supported");
    for (int at = SAVED; at < RESTORED; at++) tick(&c, controller, &p, plant, at);
    /* the instance that goes on is another one, the one that was saved is gone */
    static row first[RESTORED];
    memcpy(first, rows, sizeof first);
    memset(rows + SAVED, 0, sizeof(row) * (RESTORED - SAVED));
    c.free_instance(controller);
    bytes[size - 9] ^= 1;
    REFUSED(c.deserialize(other, bytes, size, &saved[0]), "no serialized state");
    bytes[size - 9] ^= 1;
    REFUSED(c.deserialize(other, bytes, size - 1, &saved[0]), "no serialized state");
    REQUIRE(c.deserialize(other, bytes, size, &saved[0]) == OK && c.restore(other, saved[0]) == OK);
    REQUIRE(p.restore(plant, saved[1]) == OK);
    for (int at = SAVED; at < RESTORED; at++) tick(&c, other, &p, plant, at);
    REQUIRE(memcmp(first, rows, sizeof first) == 0);
    REQUIRE(c.save(other, &saved[0]) == OK && c.free_state(other, &saved[0]) == OK);
    REQUIRE(p.free_state(plant, &saved[1]) == OK);

    /* of the processor's time, in which other programs have no part */
    struct timespec begin, end;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    for (int at = RESTORED; at < TICKS; at++) tick(&c, other, &p, plant, at);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    double seconds = (end.tv_sec - begin.tv_sec) + 1e-9 * (end.tv_nsec - begin.tv_nsec);
    double rate = (TICKS - RESTORED) / seconds;
    printf("%.0f steps a second\n", rate);
    /* ten times the rate of the drive's ticks: a simulation of one machine is faster than the machine */
    REQUIRE(rate > 1e5);
    c.free_instance(other);
    p.free_instance(plant);
    FILE *out = fopen("output", "w");
    REQUIRE(out && fwrite(rows, sizeof rows, 1, out) == 1 && fclose(out) == 0);
    return 0;
}
