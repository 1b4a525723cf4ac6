//! Tests the server of `explore`: it answers nobody but its own page, and refuses what it cannot answer in a line.

use crate::served::Served;
use host_tests::program::{ADIS16405, json};
use serde_json::{Value, json};
use std::{fs, path::Path};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// χ² of an axis as `compare` computes it.
fn compared(arguments: &[&str], axis: usize) -> f64 {
    let arguments = [&["compare"], arguments].concat();
    number(&json(Path::new("."), &arguments)["axes"][axis]["chi2"])
}

#[test]
fn nobody_without_the_token_or_from_another_host_gets_anything() {
    let served = Served::start(&[ADIS16405]);
    let own = served.host();
    let question = r#"{"record":0}"#;
    let token = format!("/{}/", served.token());
    assert_eq!(served.token().len(), 32);
    let page = served.request("GET", &token, &[("Host", &own)], "");
    assert_eq!(page.status, 200);
    let policy = page.header("Content-Security-Policy").expect("a policy");
    assert!(
        policy.contains("default-src 'none'") && !policy.contains("unsafe"),
        "{policy}"
    );
    for word in ["src=", "url(", "@import", "href=\"http", "onclick"] {
        assert!(!page.body.contains(word), "{word}");
    }
    // Another run has another token and another port.
    let other = Served::start(&[ADIS16405]);
    assert!(other.token() != served.token() && other.host() != own);

    let wrong = "0".repeat(32);
    let longer = format!("/{}0/", served.token());
    let shorter = format!("/{}/", &served.token()[..31]);
    let fit = format!("{token}fit");
    let elsewhere = format!("evil.example:{}", served.port());
    let refused = [
        ("GET", "/", own.as_str(), None),
        ("GET", "/favicon.ico", &own, None),
        ("GET", &format!("/{wrong}/"), &own, None),
        ("GET", &longer, &own, None),
        ("GET", &shorter, &own, None),
        ("POST", &format!("/{wrong}/fit"), &own, None),
        ("GET", &format!("//{}/", served.token()), &own, None),
        ("GET", &token, "evil.example", None),
        ("GET", &token, &elsewhere, None),
        ("GET", &token, "127.0.0.1", None),
        ("POST", &fit, &own, Some("http://evil.example")),
        ("POST", &fit, &own, Some("null")),
    ];
    for (method, path, host, origin) in refused {
        let mut headers = vec![("Host", host)];
        headers.extend(origin.map(|origin| ("Origin", origin)));
        let answer = served.request(method, path, &headers, question);
        assert_eq!(
            (answer.status, answer.body.as_str()),
            (403, ""),
            "{method} {path} {host}"
        );
    }
    let two = served.request(
        "GET",
        &token,
        &[("Host", &own), ("Host", "evil.example")],
        "",
    );
    assert_ne!(two.status, 200);
    // With the token, nothing is served but the page and its answers.
    let input = Path::new(ADIS16405).file_name().unwrap().to_str().unwrap();
    for path in [
        input,
        "../fit",
        "fit/../../etc/passwd",
        "/etc/passwd",
        "%2e%2e/Cargo.toml",
        "fit?x",
        "page.js",
    ] {
        let answer = served.request(
            "POST",
            &format!("{token}{path}"),
            &[("Host", &own)],
            question,
        );
        assert_eq!((answer.status, answer.body.as_str()), (404, ""), "{path}");
    }
    let answer = served.request("GET", &fit, &[("Host", &own)], "");
    assert_eq!((answer.status, answer.body.as_str()), (405, ""));
    let local = format!("localhost:{}", served.port());
    assert_eq!(
        served
            .request("GET", &token, &[("Host", &local)], "")
            .status,
        200
    );
}

#[test]
fn only_the_loopback_address_listens() {
    let served = Served::start(&[ADIS16405]);
    let port = format!(":{:04X}", served.port());
    let listening = |file: &str| -> Vec<String> {
        let table = fs::read_to_string(file).unwrap_or_default();
        let rows = table
            .lines()
            .skip(1)
            .map(|row| row.split_whitespace().collect::<Vec<_>>());
        // The fourth column is the state, of which 0A is that of a listener.
        let listeners = rows.filter(|row| row[1].ends_with(&port) && row[3] == "0A");
        listeners.map(|row| row[1].to_owned()).collect()
    };
    assert_eq!(listening("/proc/net/tcp"), [format!("0100007F{port}")]);
    assert!(listening("/proc/net/tcp6").is_empty());
}

#[test]
fn hostile_questions_are_refused_in_a_line_and_do_not_stop_the_server() {
    let served = Served::start(&[ADIS16405]);
    let deep = "[".repeat(50_000);
    let many: Vec<&str> = vec!["sinusoid:frequency_hz=1"; 50];
    let long = "x".repeat(5000);
    let refused = [
        (String::new(), "the request is not understood"),
        ("[]".into(), "the request is not understood"),
        ("{}".into(), "missing field `record`"),
        ("null".into(), "the request is not understood"),
        ("NaN".into(), "the request is not understood"),
        (r#"{"record":NaN}"#.into(), "the request is not understood"),
        (r#"{"record":-1}"#.into(), "the request is not understood"),
        (r#"{"record":0.5}"#.into(), "the request is not understood"),
        (r#"{"record":1e99}"#.into(), "the request is not understood"),
        (r#"{"record":"0"}"#.into(), "the request is not understood"),
        (
            r#"{"record":3}"#.into(),
            "there is no record 3; give a number from 0 to 2",
        ),
        (
            r#"{"record":0,"judged":[9]}"#.into(),
            "there is no record 9",
        ),
        (
            r#"{"record":0,"judged":1}"#.into(),
            "the request is not understood",
        ),
        (
            r#"{"record":0,"with":[1]}"#.into(),
            "the request is not understood",
        ),
        (
            r#"{"record":0,"with":"sinusoid"}"#.into(),
            "the request is not understood",
        ),
        (r#"{"record":0,"more":1}"#.into(), "unknown field `more`"),
        (deep, "the request is not understood"),
        (
            json!({ "record": 0, "with": many }).to_string(),
            "more than 8 effects",
        ),
        (
            json!({ "record": 0, "with": [long] }).to_string(),
            "no such effect; choose from",
        ),
        (
            json!({ "record": 0, "with": ["a\nb\u{0}<script>"] }).to_string(),
            "no such effect",
        ),
        (
            json!({ "record": 0, "without": ["sinusoid"] }).to_string(),
            "not in the model; choose from",
        ),
        (
            json!({ "record": 0, "with": ["sinusoid:frequency_hz=NaN"] }).to_string(),
            "not a finite number",
        ),
        (
            json!({ "record": 0, "with": ["sinusoid:frequency_hz=1e999"] }).to_string(),
            "not a finite number",
        ),
        (
            json!({ "record": 0, "with": ["sinusoid:frequency=1"] }).to_string(),
            "choose from frequency_hz",
        ),
        (
            json!({ "record": 0, "with": ["low_pass:time_constant_s=0.1,poles=1e300"] })
                .to_string(),
            "give a whole number",
        ),
    ];
    let one_line = |body: &str| {
        let refused: Value =
            serde_json::from_str(body).unwrap_or_else(|error| panic!("{error}: {body}"));
        let line = refused["error"].as_str().unwrap().to_owned();
        assert!(line.contains("; ") && !line.contains('\n'), "{line}");
        line
    };
    for (body, message) in refused {
        for name in ["fit", "diagnose", "drawing", "table"] {
            if name == "diagnose" && body.contains("with") {
                continue;
            }
            let answer = served.post(name, &body);
            assert_eq!(answer.status, 400, "{name}: {body}");
            assert!(
                one_line(&answer.body).contains(message),
                "{}: {message}",
                answer.body
            );
        }
    }
    let large = format!(r#"{{"record":0,"with":["{}"]}}"#, "x".repeat(1 << 17));
    let answer = served.post("fit", &large);
    assert_eq!((answer.status, answer.body.as_str()), (413, ""));
    // Every effect with numbers that are far out of its range: either there is a fit or a line that says why not.
    for effect in allanite::effect::CATALOGUE {
        let names: Vec<&str> = effect
            .parameters()
            .iter()
            .filter(|one| !one.is_whole)
            .map(|one| one.name)
            .collect();
        if names.is_empty() {
            continue;
        }
        for value in ["1e-308", "1e-30", "1e-3", "1e30", "1.7e308"] {
            for sign in ["=", "~"] {
                let pairs: Vec<String> = names
                    .iter()
                    .map(|name| format!("{name}{sign}{value}"))
                    .collect();
                let with = format!("{}:{}", effect.name(), pairs.join(","));
                let answer =
                    served.post("fit", &json!({ "record": 2, "with": [with] }).to_string());
                match answer.status {
                    200 => assert!(
                        serde_json::from_str::<Value>(&answer.body).is_ok(),
                        "{with}"
                    ),
                    400 => drop(one_line(&answer.body)),
                    status => panic!("{with}: {status}"),
                }
            }
        }
    }
    let answer = served.post("fit", r#"{"record":0}"#);
    assert_eq!(answer.status, 200);
    let answer: Value = serde_json::from_str(&answer.body).unwrap();
    assert!((number(&answer["chi2"]) / compared(&[ADIS16405], 0) - 1.0).abs() < 1e-12);
    let errors = served.end();
    assert!(!errors.contains("panicked"), "{errors}");
}
