// SPDX-License-Identifier: Apache-2.0
#include <xtrack/session.hpp>

#include <cstdio>

int main() {
    auto session = xtrack::Session::open("sim");  // or the folder of a recording
    if (session)
        session->subscribe(xtrack::GestureType::swipe, [](const xtrack::GestureEvent& event) {
            if (event.phase == xtrack::EventPhase::end)
                std::puts(to_string(event.direction));
        });
    const xtrack::Result<void> result = session ? session->run() : session.error();
    if (!result)
        std::fprintf(stderr, "%s\n", result.error().message.c_str());
    return result ? 0 : 1;
}
