#!/bin/sh
# Install a Chromium for the tests of the web page: the distribution's if apt is available, otherwise Playwright's.
# Where that is not allowed, say what to install: the tests that need it are skipped.
set -eu
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then
        "$name" --version 2>/dev/null || true
        exit 0
    fi
done
skip() {
    echo "The tests of the page in a browser are skipped: there is none. To run them: $1"
    exit 0
}
if command -v apt-get >/dev/null 2>&1; then
    by_hand="apt-get install chromium fonts-dejavu-core, as root"
    run=""
    if [ "$(id -u)" -ne 0 ]; then
        sudo -n true >/dev/null 2>&1 || skip "$by_hand"
        run="sudo -n"
    fi
    echo "Installing Chromium, which the tests of the page need."
    $run apt-get update -qq >/dev/null 2>&1 &&
        $run env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
            chromium fonts-dejavu-core >/dev/null 2>&1 || skip "$by_hand"
    chromium --version
else
    python -m playwright install chromium >/dev/null 2>&1 || skip "python -m playwright install --with-deps chromium"
fi
