/// libFuzzer target: the records that compare and tune keep of finished work, and read when they are run again (the only
/// caches on disk). Any bytes there mean "not done yet", a record, or an Error.
#include <string>

#include <pellucid/base/error.h>

#include "../../src/study/run_store.h"
#include "../../src/study/tune_trials.h"
#include "scratch.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pellucid;
    static const RunKey kKey{"path", "key", 1.0, 0};
    static const fuzz::ScratchFile kRecord("runs/" + kKey.name() + ".json"), kTrials("trials.json");
    static const RunStore kStore(kRecord.folder());
    kRecord.write(data, size);
    try {
        if (const auto run = kStore.find(kKey)) (void)kStore.readImage(*run);
    } catch (const Error&) {
    }
    try {
        const TrialJournal journal(kTrials.write(data, size), "key");
        (void)journal.find("", {});
    } catch (const Error&) {
    }
    return 0;
}
