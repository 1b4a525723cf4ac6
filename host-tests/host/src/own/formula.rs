//! Formulas of one variable with parameters: `1/(1 + (f/corner_hz)^2)`.

use super::refusal::Refusal;
use allanite_log::failure::quoted;
use winnow::{
    ModalResult, Parser,
    ascii::{digit0, digit1, multispace0},
    combinator::{
        Infix, Prefix, alt, cut_err, delimited, dispatch, expression, fail, opt, preceded,
        separated,
    },
    stream::LocatingSlice,
    token::{any, one_of, take_while},
};

/// The longest formula, in bytes, and the deepest one, in parentheses, signs and powers. Chosen by hand, so that no formula
/// exhausts the stack.
const LONGEST: usize = 4000;
const DEEPEST: usize = 60;

/// A function of one number.
type Function = fn(f64) -> f64;

/// The functions of one number.
const FUNCTIONS: [(&str, Function); 15] = [
    ("abs", f64::abs),
    ("acos", f64::acos),
    ("asin", f64::asin),
    ("atan", f64::atan),
    ("cos", f64::cos),
    ("cosh", f64::cosh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sin", f64::sin),
    ("sinc", |x| if x == 0.0 { 1.0 } else { x.sin() / x }),
    ("sinh", f64::sinh),
    ("sqrt", f64::sqrt),
    ("tan", f64::tan),
    ("tanh", f64::tanh),
];

/// A formula that was read. Its variable is number 0, its parameters follow.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Formula(Node);

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Number(f64),
    Variable(usize),
    Negative(Box<Self>),
    Operation(char, Box<[Self; 2]>),
    Function(usize, Box<Self>),
    Least(Vec<Self>),
    Most(Vec<Self>),
    Points(Box<Self>, Points),
}

/// Straight lines between points, which are drawn over logarithms if all numbers are above zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Points {
    points: Vec<[f64; 2]>,
    has_logarithms: bool,
}

/// What the text says, before its names are looked up.
#[derive(Clone, Debug)]
enum Read<'a> {
    Number(f64),
    Name(&'a str),
    Call(&'a str, Vec<Self>),
    Negative(Box<Self>),
    Operation(char, Box<[Self; 2]>),
}

type Input<'a> = LocatingSlice<&'a str>;

impl Formula {
    /// Reads a formula of `variable` and of parameters, which are added to `parameters` where they occur first.
    ///
    /// # Errors
    /// What is wrong and what to write instead.
    pub(super) fn parse(
        text: &str,
        variable: &str,
        parameters: &mut Vec<String>,
    ) -> Result<Self, Refusal> {
        if text.len() > LONGEST || depth(text) > DEEPEST {
            return Err((
                "the formula is too long, or too deep".into(),
                "write a shorter one, or a file of points".into(),
            ));
        }
        if text.trim().is_empty() {
            return Err((
                "the formula is empty".into(),
                format!("write one of {variable}"),
            ));
        }
        let read = whole.parse(LocatingSlice::new(text)).map_err(|error| {
            let at = error.offset().min(text.len());
            misread(text, at)
        })?;
        Ok(Self(Node::of(read, variable, parameters)?))
    }

    /// The formula that goes through these points.
    pub(super) fn through(points: Points) -> Self {
        Self(Node::Points(Box::new(Node::Variable(0)), points))
    }

    /// The value for these numbers, of which the first is the variable. It may be no number.
    pub(super) fn value(&self, numbers: &[f64]) -> f64 {
        self.0.value(numbers)
    }
}

/// How deep the parts of a formula lie in each other, at most.
fn depth(text: &str) -> usize {
    let (mut open, mut deepest, mut run, mut signs) = (0_usize, 0, 0_usize, 0);
    for c in text.chars() {
        open = match c {
            '(' => open + 1,
            ')' => open.saturating_sub(1),
            _ => open,
        };
        run = match c {
            '-' | '+' => run + 1,
            _ if c.is_whitespace() => run,
            _ => 0,
        };
        deepest = deepest.max(open);
        signs = signs.max(run);
    }
    deepest + signs + text.matches('^').count()
}

fn whole<'a>(input: &mut Input<'a>) -> ModalResult<Read<'a>> {
    delimited(multispace0, sum, multispace0).parse_next(input)
}

/// Powers bind from the right and before a sign, as in mathematics: `-f^2` is the negative of a square.
fn sum<'a>(input: &mut Input<'a>) -> ModalResult<Read<'a>> {
    fn both<'a>(sign: char, one: Read<'a>, other: Read<'a>) -> Read<'a> {
        Read::Operation(sign, Box::new([one, other]))
    }
    expression(delimited(multispace0, operand, multispace0))
        .prefix(preceded(
            multispace0,
            dispatch! {any;
                '-' => Prefix(7, |_: &mut Input<'a>, a| Ok(Read::Negative(Box::new(a)))),
                '+' => Prefix(7, |_: &mut Input<'a>, a| Ok(a)),
                _ => fail,
            },
        ))
        .infix(dispatch! {any;
            '+' => Infix::Left(3, |_: &mut Input<'a>, a, b| Ok(both('+', a, b))),
            '-' => Infix::Left(3, |_: &mut Input<'a>, a, b| Ok(both('-', a, b))),
            '*' => Infix::Left(5, |_: &mut Input<'a>, a, b| Ok(both('*', a, b))),
            '/' => Infix::Left(5, |_: &mut Input<'a>, a, b| Ok(both('/', a, b))),
            '^' => Infix::Right(9, |_: &mut Input<'a>, a, b| Ok(both('^', a, b))),
            _ => fail,
        })
        .parse_next(input)
}

fn operand<'a>(input: &mut Input<'a>) -> ModalResult<Read<'a>> {
    alt((
        number,
        call,
        name.map(Read::Name),
        delimited('(', cut_err(sum), cut_err(')')),
    ))
    .parse_next(input)
}

fn number<'a>(input: &mut Input<'a>) -> ModalResult<Read<'a>> {
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1).void();
    (mantissa, opt(exponent))
        .take()
        .parse_to()
        .map(Read::Number)
        .parse_next(input)
}

fn name<'a>(input: &mut Input<'a>) -> ModalResult<&'a str> {
    (
        one_of(|c: char| c.is_ascii_alphabetic() || c == 'π'),
        take_while(0.., |c: char| c.is_ascii_alphanumeric() || c == '_'),
    )
        .take()
        .parse_next(input)
}

fn call<'a>(input: &mut Input<'a>) -> ModalResult<Read<'a>> {
    let arguments = delimited('(', cut_err(separated(1.., sum, ',')), cut_err(')'));
    (name, arguments)
        .map(|(name, arguments)| Read::Call(name, arguments))
        .parse_next(input)
}

/// What is wrong at a place of the text.
fn misread(text: &str, at: usize) -> Refusal {
    let rest = text.get(at..).unwrap_or_default().trim_start();
    let before = text.get(..at).unwrap_or_default().trim_end();
    let what = match rest.chars().next() {
        None => "the formula ends too early".to_owned(),
        Some(_) => format!(
            "the formula is not understood from {} on",
            quoted(rest.as_bytes())
        ),
    };
    let is_value = |c: char| c.is_alphanumeric() || c == ')';
    let remedy = if text.contains("**") {
        "write ^ for a power"
    } else if text.contains("()") {
        "write a number or a name between the parentheses"
    } else if rest.is_empty() && text.matches('(').count() > text.matches(')').count() {
        "close the parenthesis"
    } else if rest.starts_with(')') && text.matches('(').count() < text.matches(')').count() {
        "open the parenthesis, or leave this one out"
    } else if rest.starts_with(['²', '³']) {
        "write ^2 or ^3 for a power"
    } else if rest.starts_with(['−', '–']) {
        "write - for a minus"
    } else if rest.starts_with(['·', '×']) {
        "write * between factors"
    } else if rest.starts_with(',') {
        "write a decimal point, and commas only between the numbers of a function"
    } else if before.ends_with(is_value) && rest.starts_with(|c: char| is_value(c) || c == '(') {
        "write * between factors"
    } else {
        "write numbers, names, + - * / ^, parentheses and functions such as exp(…)"
    };
    (what, remedy.into())
}

impl Node {
    /// Looks names up, and computes what has no variable.
    fn of(read: Read<'_>, variable: &str, parameters: &mut Vec<String>) -> Result<Self, Refusal> {
        let node = match read {
            Read::Number(number) => Self::Number(number),
            Read::Name("pi" | "π") => Self::Number(std::f64::consts::PI),
            Read::Name(name) if name == variable => Self::Variable(0),
            Read::Name(name @ ("f" | "t")) => {
                return Err((
                    format!("there is no {name} here"),
                    match name {
                        "f" => "a covariance is a function of t, the lag in seconds".into(),
                        _ => "a density is a function of f, the frequency in Hz".into(),
                    },
                ));
            }
            Read::Name(name) => {
                let at = parameters.iter().position(|other| other == name);
                let at = at.unwrap_or_else(|| {
                    parameters.push(name.to_owned());
                    parameters.len() - 1
                });
                Self::Variable(1 + at)
            }
            Read::Negative(inner) => {
                Self::Negative(Box::new(Self::of(*inner, variable, parameters)?))
            }
            Read::Operation(sign, both) => {
                let [one, other] = *both;
                Self::Operation(
                    sign,
                    Box::new([
                        Self::of(one, variable, parameters)?,
                        Self::of(other, variable, parameters)?,
                    ]),
                )
            }
            Read::Call(name, arguments) => {
                let arguments = arguments
                    .into_iter()
                    .map(|one| Self::of(one, variable, parameters))
                    .collect::<Result<Vec<_>, _>>()?;
                Self::call(name, arguments)?
            }
        };
        // What has no variable is computed once.
        Ok(match node.is_constant() {
            true => Self::Number(node.value(&[])),
            false => node,
        })
    }

    fn call(name: &str, mut arguments: Vec<Self>) -> Result<Self, Refusal> {
        let count = arguments.len();
        let takes = |what: &str| {
            Err((
                format!("{name} takes {what}, not {count}"),
                "give it as many".into(),
            ))
        };
        match name {
            "min" => return Ok(Self::Least(arguments)),
            "max" => return Ok(Self::Most(arguments)),
            "points" => return Self::points(arguments),
            _ => {}
        }
        let Some(function) = FUNCTIONS.iter().position(|(other, _)| *other == name) else {
            let mut names: Vec<&str> = FUNCTIONS.iter().map(|(name, _)| *name).collect();
            names.extend(["max", "min", "points"]);
            let hint = match name {
                "log" => "write ln or log10; ".to_owned(),
                _ => allanite_log::failure::did_you_mean(name, names.iter().copied()),
            };
            return Err((
                format!("there is no function {}", quoted(name.as_bytes())),
                format!("{hint}choose from {}", names.join(", ")),
            ));
        };
        match (arguments.pop(), count) {
            (Some(argument), 1) => Ok(Self::Function(function, Box::new(argument))),
            _ => takes("one number"),
        }
    }

    fn points(arguments: Vec<Self>) -> Result<Self, Refusal> {
        let mut arguments = arguments.into_iter();
        let at = arguments.next().unwrap_or(Self::Number(0.0));
        let numbers: Option<Vec<f64>> = arguments
            .map(|one| match one {
                Self::Number(number) => Some(number),
                _ => None,
            })
            .collect();
        let numbers = numbers.unwrap_or_default();
        let (points, rest) = numbers.as_chunks::<2>();
        if !rest.is_empty() {
            return Err((
                "points has an x without a y".into(),
                "write points(f, x1, y1, x2, y2, …)".into(),
            ));
        }
        Ok(Self::Points(Box::new(at), Points::new(points.to_vec())?))
    }

    fn is_constant(&self) -> bool {
        match self {
            Self::Number(_) => true,
            Self::Variable(_) => false,
            Self::Negative(one) | Self::Function(_, one) | Self::Points(one, _) => {
                one.is_constant()
            }
            Self::Operation(_, both) => both.iter().all(Self::is_constant),
            Self::Least(all) | Self::Most(all) => all.iter().all(Self::is_constant),
        }
    }

    fn value(&self, numbers: &[f64]) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Variable(at) => numbers.get(*at).copied().unwrap_or(f64::NAN),
            Self::Negative(one) => -one.value(numbers),
            Self::Operation(sign, both) => {
                let [one, other] = both.each_ref().map(|one| one.value(numbers));
                match sign {
                    '+' => one + other,
                    '-' => one - other,
                    '*' => one * other,
                    '/' => one / other,
                    _ => power(one, other),
                }
            }
            Self::Function(at, one) => {
                let value = one.value(numbers);
                FUNCTIONS
                    .get(*at)
                    .map_or(f64::NAN, |(_, function)| function(value))
            }
            Self::Least(all) => extreme(all, numbers, f64::min),
            Self::Most(all) => extreme(all, numbers, f64::max),
            Self::Points(at, points) => points.at(at.value(numbers)),
        }
    }
}

/// The least or the greatest of some values.
fn extreme(all: &[Node], numbers: &[f64], choose: fn(f64, f64) -> f64) -> f64 {
    let values = all.iter().map(|one| one.value(numbers));
    values.reduce(choose).unwrap_or(f64::NAN)
}

/// A power; whole ones are products, which is faster.
fn power(base: f64, exponent: f64) -> f64 {
    match exponent.fract() == 0.0 && exponent.abs() <= 16.0 {
        true => base.powi(exponent as i32),
        false => base.powf(exponent),
    }
}

impl Points {
    /// A curve through points; it stays where it is beyond the last ones.
    ///
    /// # Errors
    /// When there are fewer than two, or they do not ascend.
    pub(super) fn new(points: Vec<[f64; 2]>) -> Result<Self, Refusal> {
        if points.len() < 2 {
            return Err((
                "there are fewer than two points".into(),
                "give two or more, as numbers: points(f, x1, y1, x2, y2, …)".into(),
            ));
        }
        let ascend = points.is_sorted_by(|[one, _], [other, _]| one < other);
        if !ascend || points.as_flattened().iter().any(|x| !x.is_finite()) {
            return Err((
                "the points do not ascend".into(),
                "sort them, each x once".into(),
            ));
        }
        Ok(Self {
            has_logarithms: points.as_flattened().iter().all(|number| *number > 0.0),
            points,
        })
    }

    fn at(&self, x: f64) -> f64 {
        let right = self.points.partition_point(|[other, _]| *other <= x);
        let left = right.checked_sub(1).and_then(|left| self.points.get(left));
        match (left, self.points.get(right)) {
            (Some(&[x1, y1]), Some(&[x2, y2])) if self.has_logarithms => {
                y1 * (y2 / y1).powf((x / x1).ln() / (x2 / x1).ln())
            }
            (Some(&[x1, y1]), Some(&[x2, y2])) => y1 + (y2 - y1) * (x - x1) / (x2 - x1),
            (Some([_, y]), None) | (None, Some([_, y])) if !x.is_nan() => *y,
            _ => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let mut parameters = Vec::new();
        let formula = Formula::parse(text, "f", &mut parameters).expect(text);
        formula.value(&[2.0, 5.0])
    }

    /// Crates that evaluate formulas, exmex 0.21.0 and fasteval3 3.0.1, take `-f^2` for `(-f)^2`, so that a bell `exp(-f^2)`
    /// would grow; see `findings/fasteval-bell-grows.sh`. exmex takes `2^3^2` for `(2^3)^2` and does not read `1e3`.
    #[test]
    fn signs_and_powers_are_those_of_mathematics() {
        assert_eq!(value("-f^2"), -4.0);
        assert_eq!(value("exp(-f^2)"), (-4.0_f64).exp());
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("2*-f^2"), -8.0);
        assert_eq!(value("-f^-2"), -0.25);
        assert_eq!(value("1 - 2 - 3"), -4.0);
        assert_eq!(value("8/2/2"), 2.0);
        assert_eq!(value("1e3 + 2.5E-1 + .5 + 5."), 1005.75);
        assert_eq!(value("--f + +1"), 3.0);
        assert!(value("0/0").is_nan());
    }

    #[test]
    fn names_are_the_variable_constants_parameters_and_functions() {
        assert_eq!(
            value(" 1/( 1+(f/corner_hz)^2 ) "),
            1.0 / (1.0 + 0.4_f64.powi(2))
        );
        assert_eq!(value("cos(2*pi*f)"), 1.0);
        assert_eq!(value("min(f, 3, 1) + max(f, 7)"), 8.0);
        assert_eq!(value("sinc(0)"), 1.0);
        assert_eq!(value("points(f, 1, 1, 4, 16)"), 4.0);
        assert_eq!(value("points(f, 0, 1, 4, 3)"), 2.0);
        assert_eq!(value("points(9, 1, 1, 4, 16)"), 16.0);
        let mut parameters = Vec::new();
        let formula = Formula::parse("a*f + b*a", "f", &mut parameters).expect("a formula");
        assert_eq!(parameters, ["a", "b"]);
        assert_eq!(formula.value(&[2.0, 3.0, 5.0]), 21.0);
    }

    #[test]
    fn what_is_wrong_is_told_in_a_line_with_what_to_write() {
        let deep = format!("{}1{}", "(".repeat(70), ")".repeat(70));
        let signs = format!("{}1", "-".repeat(70));
        for (text, expected) in [
            ("", "empty"),
            ("1+", "ends too early"),
            ("(1+f", "close the parenthesis"),
            ("sin(f", "close the parenthesis"),
            ("1+f)", "from \")\" on; open the parenthesis"),
            ("f**2", "write ^ for a power"),
            ("2f", "from \"f\" on; write * between factors"),
            ("2(f)", "write * between factors"),
            ("f f", "write * between factors"),
            ("f²", "write ^2"),
            ("1−f", "write - for a minus"),
            ("2·f", "write * between factors"),
            ("1,5", "write a decimal point"),
            ("1.2.3", "not understood from \".3\" on"),
            ("f$", "not understood from \"$\" on"),
            ("()", "between the parentheses"),
            ("log(f)", "no function \"log\"; write ln or log10"),
            ("sine(f)", "no function \"sine\"; did you mean"),
            ("exp(f, 2)", "exp takes one number, not 2"),
            ("t", "there is no t here; a density is a function of f"),
            ("points(f, 1, 2)", "fewer than two points"),
            ("points(f, 1, 2, 3)", "an x without a y"),
            ("points(f, 3, 2, 1, 2)", "do not ascend"),
            ("points(f, 3, f, 1, 2)", "fewer than two points"),
            (&"2^".repeat(70), "too deep"),
            (&deep, "too deep"),
            (&signs, "too deep"),
        ] {
            let told = Formula::parse(text, "f", &mut Vec::new()).expect_err(text);
            let told = format!("{}; {}", told.0, told.1);
            assert!(told.contains(expected), "{text}: {told}");
            assert!(!told.contains('\n'));
        }
    }
}
