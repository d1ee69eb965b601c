// SPDX-License-Identifier: Apache-2.0
#include <xtrack/session.hpp>

#include <cstdio>

int main() {
    auto session = xtrack::Session::open("sim");  // or the folder of a recording
    if (!session) {
        std::fprintf(stderr, "%s\n", session.error().message.c_str());
        return 1;
    }
    session->subscribe(xtrack::GestureType::swipe, [](const xtrack::GestureEvent& event) {
        if (event.phase == xtrack::EventPhase::end)
            std::puts(to_string(event.direction));
    });
    return session->run() ? 0 : 1;
}
