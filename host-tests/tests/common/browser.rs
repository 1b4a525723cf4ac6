//! Shows a page as a reader sees it: in a Chromium without a window, controlled by its DevTools
//! protocol.

use serde_json::{Value, json};
use std::{
    fs,
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};
use xtask::CHROMIUM;

const PATIENCE: Duration = Duration::from_secs(60);

/// A Chromium with one tab.
pub(crate) struct Browser {
    process: Child,
    socket: WebSocket<TcpStream>,
    session: Option<String>,
    calls: u64,
    loaded: bool,
    /// The errors and warnings that the console shows.
    pub(crate) complaints: Vec<String>,
    // The profile must live longer than the process.
    _profile: TempDir,
}

impl Browser {
    /// Starts Chromium.
    pub(crate) fn start() -> Self {
        let profile = TempDir::new().unwrap();
        let process = Command::new(CHROMIUM)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
            ])
            .args(["--no-first-run", "--remote-debugging-port=0"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| {
                panic!("{CHROMIUM}: {error}; install it with `cargo xtask setup`")
            });
        let address = address(profile.path());
        let (host, _) = address.split_once("/devtools").unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(format!("ws://{address}"), stream).unwrap();
        let mut browser = Self {
            process,
            socket,
            session: None,
            calls: 0,
            loaded: false,
            complaints: Vec::new(),
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", target);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser
    }

    /// Opens an address and waits until it is loaded.
    pub(crate) fn open(&mut self, url: &str) {
        self.loaded = false;
        let answer = self.call("Page.navigate", json!({ "url": url }));
        assert!(answer["errorText"].is_null(), "{answer}");
        while !self.loaded {
            self.receive();
        }
    }

    /// The value of an expression in JavaScript.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let arguments = json!({ "expression": expression, "returnByValue": true });
        let answer = self.call("Runtime.evaluate", arguments);
        assert!(
            answer["exceptionDetails"].is_null(),
            "{expression}: {answer}"
        );
        answer["result"]["value"].clone()
    }

    /// The text of the first element that matches a selector.
    pub(crate) fn text(&mut self, selector: &str) -> String {
        let text = self.value(&format!("document.querySelector({selector:?}).innerText"));
        text.as_str().unwrap().to_owned()
    }

    /// The box of an element, which is scrolled into the middle of the window: left, top, width and height.
    pub(crate) fn sight(&mut self, selector: &str) -> [f64; 4] {
        let found = self.value(&format!(
            "(() => {{ const element = document.querySelector({selector:?}); \
             element.scrollIntoView({{ block: 'center' }}); \
             const box = element.getBoundingClientRect(); \
             return [box.x, box.y, box.width, box.height]; }})()"
        ));
        [0, 1, 2, 3].map(|at| found[at].as_f64().unwrap_or_else(|| panic!("{selector}")))
    }

    /// Clicks the middle of an element with the mouse.
    pub(crate) fn click(&mut self, selector: &str) {
        let [x, y, width, height] = self.sight(selector);
        let middle = [x + width / 2.0, y + height / 2.0];
        self.mouse("mousePressed", middle);
        self.mouse("mouseReleased", middle);
    }

    /// An event of the mouse at a place of the window. While the mouse moves, no button is pressed.
    pub(crate) fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let mut event = json!({ "type": kind, "x": x, "y": y });
        if kind != "mouseMoved" {
            event["button"] = "left".into();
            event["clickCount"] = 1.into();
        }
        self.call("Input.dispatchMouseEvent", event);
    }

    /// Presses the mouse, moves it to another place and releases it.
    pub(crate) fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        self.mouse("mousePressed", from);
        for step in 1..=4 {
            let share = f64::from(step) / 4.0;
            let [x, y] = [0, 1].map(|at| from[at] + share * (to[at] - from[at]));
            let event =
                json!({ "type": "mouseMoved", "x": x, "y": y, "button": "left", "buttons": 1 });
            self.call("Input.dispatchMouseEvent", event);
        }
        self.mouse("mouseReleased", to);
    }

    /// Turns the wheel at a place, upwards if it is negative.
    pub(crate) fn wheel(&mut self, [x, y]: [f64; 2], turn: f64) {
        let event = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": turn });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// Puts fingers on these places, moves them along and lifts them.
    pub(crate) fn touch(&mut self, path: &[&[[f64; 2]]]) {
        let enabled = json!({ "enabled": true, "maxTouchPoints": 5 });
        self.call("Emulation.setTouchEmulationEnabled", enabled);
        for (at, fingers) in path.iter().enumerate() {
            let points = fingers.iter().enumerate();
            let points: Vec<Value> = points
                .map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }))
                .collect();
            let kind = if at == 0 { "touchStart" } else { "touchMove" };
            self.call(
                "Input.dispatchTouchEvent",
                json!({ "type": kind, "touchPoints": points }),
            );
        }
        self.call(
            "Input.dispatchTouchEvent",
            json!({ "type": "touchEnd", "touchPoints": [] }),
        );
    }

    /// Presses a key, such as `ArrowDown` or `+`, on the element with the focus.
    pub(crate) fn press(&mut self, key: &str) {
        let (code, text) = match key {
            "ArrowLeft" => (37, ""),
            "ArrowUp" => (38, ""),
            "ArrowRight" => (39, ""),
            "ArrowDown" => (40, ""),
            "Home" => (36, ""),
            "End" => (35, ""),
            "Tab" => (9, ""),
            "Escape" => (27, ""),
            "Enter" => (13, "\r"),
            "+" => (187, "+"),
            "-" => (189, "-"),
            "0" => (48, "0"),
            _ => panic!("{key}"),
        };
        let down = if text.is_empty() {
            "rawKeyDown"
        } else {
            "keyDown"
        };
        for kind in [down, "keyUp"] {
            let mut event = json!({ "type": kind, "key": key, "windowsVirtualKeyCode": code });
            if kind == "keyDown" {
                event["text"] = text.into();
            }
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// The elements with a role of a control to which assistive technology can give no name.
    pub(crate) fn nameless(&mut self) -> Vec<String> {
        let tree = self.call("Accessibility.getFullAXTree", json!({}));
        const CONTROLS: [&str; 11] = [
            "button",
            "link",
            "slider",
            "checkbox",
            "radio",
            "combobox",
            "textbox",
            "searchbox",
            "spinbutton",
            "tab",
            "DisclosureTriangle",
        ];
        let nodes = tree["nodes"].as_array().unwrap().iter();
        let controls = nodes.filter(|node| {
            let role = node["role"]["value"].as_str().unwrap_or_default();
            node["ignored"] == false && CONTROLS.contains(&role)
        });
        let controls: Vec<&Value> = controls.collect();
        assert!(controls.len() >= 4, "{} controls", controls.len());
        let is_nameless = |node: &&&Value| {
            node["name"]["value"]
                .as_str()
                .unwrap_or_default()
                .trim()
                .is_empty()
        };
        controls
            .iter()
            .filter(is_nameless)
            .map(ToString::to_string)
            .collect()
    }

    /// The controls in the page that are smaller than 24 pixels one way or the other (WCAG 2.2, criterion 2.5.8).
    pub(crate) fn small_targets(&mut self) -> Value {
        self.value(
            "[...document.querySelectorAll('a, button, input, select, summary, [tabindex]')].filter((one) => { \
             const box = one.getBoundingClientRect(); \
             return one.checkVisibility() && box.width > 1 && (box.width < 23.9 || box.height < 23.9); }).map((one) => one.outerHTML.slice(0, 200))",
        )
    }

    /// Resizes the window to the given number of CSS pixels.
    pub(crate) fn resize(&mut self, width: u32, height: u32) {
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600 });
        self.call("Emulation.setDeviceMetricsOverride", metrics);
    }

    /// Emulates a medium, `screen` or `print`, and a colour scheme, `light` or `dark`.
    pub(crate) fn emulate(&mut self, medium: &str, scheme: &str) {
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        let media = json!({ "media": medium, "features": [feature] });
        self.call("Emulation.setEmulatedMedia", media);
    }

    /// Calls a method of the protocol.
    pub(crate) fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            call["sessionId"] = session.as_str().into();
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
        loop {
            let message = self.receive();
            if message["id"] == self.calls {
                assert!(message["error"].is_null(), "{method}: {message}");
                return message["result"].clone();
            }
        }
    }

    fn receive(&mut self) -> Value {
        let message = self
            .socket
            .read()
            .expect("Chromium answers within a minute");
        let message: Value = serde_json::from_str(message.to_text().unwrap()).unwrap();
        let parameters = &message["params"];
        match message["method"].as_str() {
            Some("Page.loadEventFired") => self.loaded = true,
            Some("Runtime.exceptionThrown") | Some("Log.entryAdded") => {
                self.complaints.push(parameters.to_string());
            }
            Some("Runtime.consoleAPICalled") if parameters["type"] != "log" => {
                self.complaints.push(parameters.to_string());
            }
            _ => {}
        }
        message
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The address at which Chromium listens. Chromium writes it into its profile.
fn address(profile: &Path) -> String {
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        let text = fs::read_to_string(profile.join("DevToolsActivePort")).unwrap_or_default();
        if let Some((port, path)) = text.split_once('\n') {
            return format!("127.0.0.1:{port}{}", path.trim());
        }
        thread::sleep(Duration::from_millis(20));
    }
    panic!("{CHROMIUM} did not start within a minute");
}
